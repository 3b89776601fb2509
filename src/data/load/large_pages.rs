//! Huge pages for the memory of volumes: a system clears memory page by page at the first write, and for half a
//! gigabyte of small pages that takes longer than reading.

/// Bytes of a huge page, on processors that have them.
const LARGE_PAGE: usize = 2 << 20;

/// Advises the system that memory will be filled from end to end, if it spans a huge page. Only a hint: correctness
/// does not depend on it.
pub(in crate::data::load) fn expect_to_fill<T>(start: *mut T, count: usize) {
    // Only whole huge pages: those at the ends of the allocation are shared with other memory.
    let begin = start.addr().next_multiple_of(LARGE_PAGE);
    let end = start.addr().saturating_add(count.saturating_mul(size_of::<T>())) / LARGE_PAGE * LARGE_PAGE;
    if end > begin {
        advise(start.cast::<u8>().wrapping_add(begin - start.addr()), end - begin);
    }
}

#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the system is told something of memory that is ours")]
fn advise(start: *mut u8, bytes: usize) {
    // SAFETY: the pages lie within one allocation of the caller, and MADV_HUGEPAGE changes neither their contents nor
    // their access rights.
    let _hint = unsafe { libc::madvise(start.cast(), bytes, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise(_start: *mut u8, _bytes: usize) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_keeps_what_it_holds() {
        for count in [0, 1, LARGE_PAGE / 2, 3 * LARGE_PAGE + 5] {
            let mut values = vec![7_u16; count];
            expect_to_fill(values.as_mut_ptr(), values.len());
            assert!(values.iter().all(|&value| value == 7), "{count}");
        }
    }
}
