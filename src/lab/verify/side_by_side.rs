//! Work on all cores whose results come in the order of the tasks.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// Does all tasks, as many at a time as there are cores; `each` gets the results in their order, as soon as they are there.
///
/// The first error in that order ends it; what has begun is finished.
pub(super) fn side_by_side<T: Sync, R: Send, E: Send>(
    tasks: &[T],
    work: impl Fn(&T) -> Result<R, E> + Sync,
    mut each: impl FnMut(R),
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let (send, receive) = mpsc::channel();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads.min(tasks.len()) {
            let (send, next, work) = (send.clone(), &next, &work);
            scope.spawn(move || {
                while let Some((index, task)) = take(tasks, next) {
                    // Nobody listens any more after an error.
                    if send.send((index, work(task))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(send);
        let mut done: Vec<Option<Result<R, E>>> = tasks.iter().map(|_| None).collect();
        let mut told = 0;
        for (index, result) in receive {
            done[index] = Some(result);
            while let Some(result) = done.get_mut(told).and_then(Option::take) {
                match result {
                    Ok(result) => each(result),
                    Err(error) => {
                        next.store(tasks.len(), Ordering::Relaxed);
                        return Err(error);
                    }
                }
                told += 1;
            }
        }
        Ok(())
    })
}

/// The next task that nobody has begun.
fn take<'a, T>(tasks: &'a [T], next: &AtomicUsize) -> Option<(usize, &'a T)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    tasks.get(index).map(|task| (index, task))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn upto(count: u64) -> Vec<u64> {
        (0..count).collect()
    }

    #[test]
    fn results_come_in_the_order_of_the_tasks() {
        let mut came = Vec::new();
        // The first tasks take longest.
        let work = |&task: &u64| {
            thread::sleep(Duration::from_millis(20_u64.saturating_sub(2 * task)));
            Ok::<u64, ()>(task)
        };
        assert_eq!(
            side_by_side(&upto(30), work, |task| came.push(task)),
            Ok(())
        );
        assert_eq!(came, upto(30));
    }

    #[test]
    fn the_first_error_in_order_ends_it() {
        let mut came = Vec::new();
        let work = |&task: &u64| if task % 7 == 5 { Err(task) } else { Ok(task) };
        assert_eq!(
            side_by_side(&upto(30), work, |task| came.push(task)),
            Err(5)
        );
        assert_eq!(came, upto(5));
    }

    #[test]
    fn without_tasks_there_is_nothing_to_wait_for() {
        assert_eq!(side_by_side(&upto(0), |_| Err(()), |()| ()), Ok(()));
    }
}
