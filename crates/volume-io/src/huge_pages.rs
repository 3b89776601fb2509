//! Huge pages for the memory of volumes: a system clears memory page by page at the first write, and for half a
//! gigabyte of small pages that takes longer than reading.

/// Bytes of a huge page, on processors that have them.
const HUGE_PAGE_BYTES: usize = 2 << 20;

/// Advises the system that memory will be filled from end to end, if it spans a huge page. Only a hint: correctness
/// does not depend on it.
pub(crate) fn advise_huge_pages<T>(start: *mut T, count: usize) {
    // Only whole huge pages: those at the ends of the allocation are shared with other memory.
    let begin = start.addr().next_multiple_of(HUGE_PAGE_BYTES);
    let end =
        start.addr().saturating_add(count.saturating_mul(size_of::<T>())) / HUGE_PAGE_BYTES * HUGE_PAGE_BYTES;
    if end > begin {
        advise(start.cast::<u8>().wrapping_add(begin - start.addr()), end - begin);
    }
}

#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "madvise is called for pages within the allocation of the caller")]
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
        for count in [0, 1, HUGE_PAGE_BYTES / 2, 3 * HUGE_PAGE_BYTES + 5] {
            let mut values = vec![7_u16; count];
            advise_huge_pages(values.as_mut_ptr(), values.len());
            assert!(values.iter().all(|&value| value == 7), "{count}");
        }
    }
}
