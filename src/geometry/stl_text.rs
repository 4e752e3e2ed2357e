//! The text form of an STL file: solids of facets, each with three vertices.
//!
//! Solids of a file are the parts of one surface, or bodies that make up the core together, as in a binary file. Words may be
//! in capitals. Normals are not read, since the order of the vertices says what is outside. What stands between an `endsolid`
//! and the next `solid` belongs to no solid, and is passed over.

/// Letters of a line that a message repeats: a facet's take fewer.
const SHOWN: usize = 60;

/// What belongs where a line of three coordinates does.
const VERTEX: &str = "vertex and three finite numbers";

/// Where a text is no STL.
#[derive(Debug)]
pub(super) struct Fault {
    /// triangles before it
    pub(super) triangles: usize,
    /// line, what belongs there and what stands there
    pub(super) reason: String,
}

/// Hands the corners of each triangle of a text on, in the order of the file.
///
/// # Errors
///
/// If the text is no STL file, or is cut off; then some triangles have been handed on.
pub(super) fn read(text: &str, mut push: impl FnMut([[f32; 3]; 3])) -> Result<(), Fault> {
    let mut lines = Lines {
        left: text.lines(),
        number: 0,
    };
    let mut triangles = 0;
    let mut in_a_solid = false;
    loop {
        let line = lines.next();
        let is = |word: &str| line.is_some_and(|line| starts_with(line, &[word]));
        match (in_a_solid, line) {
            (false, None) => return Ok(()),
            (false, Some(_)) => in_a_solid = is("solid"),
            (true, Some(_)) if is("endsolid") || is("solid") => in_a_solid = is("solid"),
            (true, Some(line)) if starts_with(line, &["facet", "normal"]) => {
                let corners = lines.corners();
                push(corners.map_err(|reason| Fault { triangles, reason })?);
                triangles += 1;
            }
            _ => {
                let reason = lines.refuse(line, "facet normal or endsolid");
                return Err(Fault { triangles, reason });
            }
        }
    }
}

/// Lines that are not empty, counted as in an editor.
struct Lines<'a> {
    left: std::str::Lines<'a>,
    /// of the last line that was taken, from 1
    number: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a str> {
        loop {
            let line = self.left.next()?;
            self.number += 1;
            if !line.trim().is_empty() {
                return Some(line);
            }
        }
    }

    /// The corners of a facet, and all of its lines after the first.
    fn corners(&mut self) -> Result<[[f32; 3]; 3], String> {
        self.expect(&["outer", "loop"])?;
        let mut corners = [[0.0; 3]; 3];
        for corner in &mut corners {
            let line = self.next();
            *corner = line
                .and_then(vertex)
                .ok_or_else(|| self.refuse(line, VERTEX))?;
        }
        self.expect(&["endloop"])?;
        self.expect(&["endfacet"])?;
        Ok(corners)
    }

    fn expect(&mut self, words: &[&str]) -> Result<(), String> {
        match self.next() {
            Some(line) if starts_with(line, words) => Ok(()),
            line => Err(self.refuse(line, &words.join(" "))),
        }
    }

    /// What is wrong with the line taken last, or with the end of the text.
    fn refuse(&self, line: Option<&str>, expected: &str) -> String {
        match line {
            Some(line) => {
                let shown: String = line.trim().chars().take(SHOWN).collect();
                format!(
                    "line {}: expected is {expected}, found \"{shown}\"",
                    self.number
                )
            }
            None => format!(
                "line {}: the file ends where {expected} is expected",
                self.number
            ),
        }
    }
}

fn starts_with(line: &str, words: &[&str]) -> bool {
    let mut found = line.split_whitespace();
    words
        .iter()
        .all(|word| found.next().is_some_and(|f| f.eq_ignore_ascii_case(word)))
}

fn vertex(line: &str) -> Option<[f32; 3]> {
    let mut words = line.split_whitespace();
    let is_one = words.next()?.eq_ignore_ascii_case("vertex");
    let mut corner = [0.0; 3];
    for x in &mut corner {
        *x = words.next()?.parse().ok().filter(|x: &f32| x.is_finite())?;
    }
    (is_one && words.next().is_none()).then_some(corner)
}
