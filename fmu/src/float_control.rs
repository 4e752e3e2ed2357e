//! How the processor rounds, which belongs to the host outside of a call and to the solver within it.
//!
//! A host may let tiny numbers be zero or round upwards. Results would then depend on it.

/// The host's settings, put back when this goes.
pub(crate) struct HostRounding {
    #[cfg(target_arch = "x86_64")]
    host: u32,
}

/// To the nearest number, tiny ones as they are, and no trap: what a program starts with.
#[cfg(target_arch = "x86_64")]
const STANDARD: u32 = 0x1f80;
/// The bits that say what has happened, and not what to do.
#[cfg(target_arch = "x86_64")]
const SEEN: u32 = 0x3f;

impl HostRounding {
    /// Rounds as IEEE 754 has it by default from here on.
    #[cfg(target_arch = "x86_64")]
    pub(crate) fn set_aside() -> Self {
        let host = read();
        if host & !SEEN != STANDARD {
            write(STANDARD);
        }
        Self { host }
    }

    /// Rounds as the host has set it: here nothing else is known.
    #[cfg(not(target_arch = "x86_64"))]
    pub(crate) fn set_aside() -> Self {
        Self {}
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for HostRounding {
    fn drop(&mut self) {
        if self.host & !SEEN != STANDARD {
            write(self.host);
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn read() -> u32 {
    let mut word = 0;
    // SAFETY: writes the four bytes behind the pointer, which are `word`'s.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags));
    }
    word
}

#[cfg(target_arch = "x86_64")]
fn write(word: u32) {
    // SAFETY: reads the four bytes of `word`. Each word written is the standard one, or was read from the register
    // and so has no reserved bit; the host's is back in place before the call returns.
    unsafe {
        std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, readonly, preserves_flags));
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    /// Tiny numbers as zero, in and out.
    const TINY_IS_ZERO: u32 = STANDARD | 0x8040;

    #[test]
    fn the_host_gets_back_what_it_had() {
        write(TINY_IS_ZERO);
        let inside = {
            let _host = HostRounding::set_aside();
            read() & !SEEN
        };
        let after = read() & !SEEN;
        write(STANDARD);
        assert_eq!((inside, after), (STANDARD, TINY_IS_ZERO));
    }
}
