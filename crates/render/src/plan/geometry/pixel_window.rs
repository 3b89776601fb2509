//! Pixel windows: parts of pictures for tiled rendering, where a picture exceeds the size of a texture.

/// Part of a picture that is drawn, as a rectangle of pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelWindow {
    /// Width and height of the whole picture.
    pub whole: [u32; 2],
    /// Column and row of the first pixel.
    pub first: [u32; 2],
    /// Width and height of the part.
    pub size: [u32; 2],
}

impl From<[u32; 2]> for PixelWindow {
    /// Creates the window of a whole picture.
    fn from(size: [u32; 2]) -> Self {
        Self { whole: size, first: [0, 0], size }
    }
}

impl PixelWindow {
    /// Returns the same part of a supersampled picture, with `samples` pixels for each pixel along an edge.
    #[must_use]
    pub fn supersampled(self, samples: u32) -> Self {
        let finer = |pixels: [u32; 2]| pixels.map(|n| n * samples);
        Self { whole: finer(self.whole), first: finer(self.first), size: finer(self.size) }
    }

    /// Returns the part with up to `margin` pixels around it, within the picture.
    #[must_use]
    pub fn widened(self, margin: u32) -> Self {
        let begin = self.first.map(|n| n.saturating_sub(margin));
        let end = |axis: usize| (self.first[axis] + self.size[axis] + margin).min(self.whole[axis]);
        Self { whole: self.whole, first: begin, size: [end(0) - begin[0], end(1) - begin[1]] }
    }

    /// Divides the part into two halves across its longer edge, of which the second is the larger by at most a pixel.
    #[must_use]
    pub fn halves(self) -> [Self; 2] {
        let axis = usize::from(self.size[1] > self.size[0]);
        let (mut first, mut second) = (self, self);
        first.size[axis] /= 2;
        second.first[axis] += first.size[axis];
        second.size[axis] -= first.size[axis];
        [first, second]
    }

    /// Divides a picture into bands of rows, from the top, and each band into parts, from the left. No part has an
    /// edge over `longest`, nor more than `most` pixels, unless a single row has.
    pub fn bands(whole: [u32; 2], longest: u32, most: u32) -> impl Iterator<Item = Vec<Self>> {
        let width = whole[0].min(longest.max(1));
        let height = (most / width.max(1)).clamp(1, longest.max(1));
        (0..whole[1]).step_by(height as usize).map(move |top| {
            let rows = height.min(whole[1] - top);
            let parts = (0..whole[0]).step_by(width.max(1) as usize);
            parts
                .map(|left| Self { whole, first: [left, top], size: [width.min(whole[0] - left), rows] })
                .collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_each_pixel_once_and_stay_small() {
        for (whole, longest, most) in [
            ([7, 5], 100, 100),
            ([7, 5], 3, 100),
            ([7, 5], 100, 10),
            ([7, 5], 100, 1),
            ([1, 1], 1, 1),
            ([300, 2], 64, 64),
        ] {
            let mut seen = vec![0; (whole[0] * whole[1]) as usize];
            for part in PixelWindow::bands(whole, longest, most).flatten() {
                assert_eq!(part.whole, whole);
                assert!(part.size.iter().all(|&n| n <= longest), "{part:?}");
                assert!(part.size[0] * part.size[1] <= most.max(part.size[0]), "{part:?}");
                for j in 0..part.size[1] {
                    for i in 0..part.size[0] {
                        seen[((part.first[1] + j) * whole[0] + part.first[0] + i) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{whole:?} {longest} {most}: {seen:?}");
        }
    }

    #[test]
    fn halves_cover_a_part() {
        let part = PixelWindow { whole: [90, 80], first: [4, 2], size: [21, 9] };
        let [left, right] = part.halves();
        assert_eq!(left, PixelWindow { whole: [90, 80], first: [4, 2], size: [10, 9] });
        assert_eq!(right, PixelWindow { whole: [90, 80], first: [14, 2], size: [11, 9] });
        let [_, below] = left.halves()[0].halves();
        assert_eq!(below, PixelWindow { whole: [90, 80], first: [4, 6], size: [5, 5] });
    }

    #[test]
    fn finer_parts_lie_where_they_lay() {
        let part = PixelWindow { whole: [10, 8], first: [4, 2], size: [3, 1] };
        let finer = part.supersampled(2);
        assert_eq!(finer, PixelWindow { whole: [20, 16], first: [8, 4], size: [6, 2] });
        let wider = part.widened(3);
        assert_eq!(wider, PixelWindow { whole: [10, 8], first: [1, 0], size: [9, 6] });
    }
}
