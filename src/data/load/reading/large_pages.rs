//! Memory for voxels in large pages, where a system has them for those who ask (Linux with `transparent_hugepage` at
//! `madvise`, as many distributions ship it).
//!
//! A volume's memory is used once, from its beginning to its end, and then read by every pass over its voxels: its first use
//! in pages of 4 KiB takes longer than the copy from the file, and each of them is looked up again and again.

/// Size of a large page on most processors (x86-64, and ARM with pages of 4 KiB): a multiple of the small ones on all.
#[cfg(target_os = "linux")]
const LARGE: usize = 2 << 20;

/// Asks for large pages for all of some memory that lies in whole ones. What it holds stays as it is; nothing is said where
/// the system has none.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the system is asked through the address: decision 13 has a line about it")]
pub(super) fn prefer_large_pages<T>(values: &mut [T]) {
    let bytes = size_of_val(values);
    let start = values.as_mut_ptr().cast::<std::ffi::c_void>();
    let before = start.align_offset(LARGE);
    let Some(whole) = bytes.checked_sub(before).map(|left| left / LARGE * LARGE).filter(|&whole| whole > 0)
    else {
        return;
    };
    // SAFETY: the addresses lie within `values`, which nobody else has. This advice changes how large the pages are that
    // the system puts behind them, never what they hold.
    let advised = unsafe {
        rustix::mm::madvise(start.wrapping_byte_add(before), whole, rustix::mm::Advice::LinuxHugepage)
    };
    if let Err(error) = advised {
        log::debug!("no large pages: {error}");
    }
}

#[cfg(not(target_os = "linux"))]
pub(super) fn prefer_large_pages<T>(_values: &mut [T]) {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_memory_holds_stays() {
        for count in [0usize, 1, 4096, 5 << 20] {
            let mut values: Vec<u16> = (0..count).map(|at| at as u16).collect();
            prefer_large_pages(&mut values);
            assert!(values.iter().enumerate().all(|(at, &value)| value == at as u16), "{count}");
        }
    }
}
