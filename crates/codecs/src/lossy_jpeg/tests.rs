//! Tests of lossy JPEG, with images that a minimal encoder here writes.

use super::*;

/// Encodes a segment with its marker.
fn segment(marker: u8, body: &[u8]) -> Vec<u8> {
    let length = u16::try_from(body.len() + 2).unwrap().to_be_bytes();
    [&[0xff, marker], &length[..], body].concat()
}

/// Encodes a frame header of these bits, pixels and sampling factors; each component uses table 0.
fn frame(marker: u8, bits: u8, [x, y]: [u16; 2], factors: &[u8]) -> Vec<u8> {
    let ([y1, y0], [x1, x0]) = (y.to_be_bytes(), x.to_be_bytes());
    let mut body = vec![bits, y1, y0, x1, x0, factors.len() as u8];
    body.extend((1..).zip(factors).flat_map(|(id, &both)| [id, both, 0]));
    segment(marker, &body)
}

/// Encodes tables: all quantisation steps are 2, DC codes have 5 bits, AC codes 8 bits.
fn tables() -> Vec<u8> {
    let means = [&[0; 5], &[16][..], &[0; 11], &(0..16).collect::<Vec<_>>()].concat();
    let others = [&[0x10][..], &[0; 7], &[255], &[0; 8], &(0..255).collect::<Vec<_>>()].concat();
    [
        segment(0xdb, &[&[0x10][..], &[0, 2].repeat(64)].concat()),
        segment(0xc4, &means),
        segment(0xc4, &others),
    ]
    .concat()
}

/// Encodes a scan of blocks, each a DC difference and pairs of zero run and AC coefficient.
fn scan(ids: &[u8], blocks: &[(i32, &[(u8, i32)])]) -> Vec<u8> {
    let mut bits = String::new();
    let mut put = |zeros: u8, number: i32, width: usize| {
        let size = 32 - number.unsigned_abs().leading_zeros();
        let code = u32::from(zeros) << 4 | size;
        bits.extend(format!("{code:0width$b}").chars());
        if size > 0 {
            let low = if number < 0 { number - 1 } else { number } as u32 & ((1 << size) - 1);
            bits.extend(format!("{low:0width$b}", width = size as usize).chars());
        }
    };
    for (mean, others) in blocks {
        put(0, *mean, 5);
        others.iter().for_each(|&(zeros, number)| put(zeros, number, 8));
        put(0, 0, 8);
    }
    while !bits.len().is_multiple_of(8) {
        bits.push('1');
    }
    let mut body = vec![ids.len() as u8];
    body.extend(ids.iter().flat_map(|&id| [id, 0]));
    let mut stream =
        if ids.is_empty() { Vec::new() } else { segment(0xda, &[&body[..], &[0, 63, 0]].concat()) };
    for byte in (0..bits.len()).step_by(8).map(|at| u8::from_str_radix(&bits[at..at + 8], 2).unwrap()) {
        stream.push(byte);
        if byte == 0xff {
            stream.push(0);
        }
    }
    stream
}

fn stream(parts: &[Vec<u8>]) -> Vec<u8> {
    [b"\xff\xd8", &parts.concat()[..], b"\xff\xd9"].concat()
}

/// An image of one component, 13 x 9 pixels, in four blocks.
fn grey() -> Vec<u8> {
    let blocks: [(i32, &[_]); 4] =
        [(100, &[(0, 40)]), (-300, &[]), (8000, &[(14, -3), (15, 0), (3, 7)]), (-15000, &[])];
    stream(&[tables(), frame(0xc1, 12, [13, 9], &[0x22]), scan(&[1], &blocks)])
}

/// An image of three components, 20 x 9 pixels, the first of which has twice the horizontal samples.
fn colors() -> Vec<u8> {
    let interval = segment(0xdd, &[0, 1]);
    let one = |mean| -> (i32, &[(u8, i32)]) { (mean, &[]) };
    let start = scan(&[1, 3], &[one(4), one(4), one(-4)]);
    let later = [[-4, -4, 400], [40, 40, -40], [80, 0, 0]].map(|three| scan(&[], &three.map(one)));
    let mut first = start;
    for (time, unit) in (0..).zip(later) {
        first.extend([&[0xff, 0xff, 0xd0 + time][..], &unit].concat());
    }
    let last = scan(&[2], &[one(4), one(8), one(-8), one(12)]);
    stream(&[
        tables(),
        frame(0xc1, 12, [20, 9], &[0x21, 0x11, 0x11]),
        interval,
        first,
        segment(0xdd, &[0, 0]),
        last,
    ])
}

#[test]
fn waves_stand_on_means() {
    let picture = decode(&grey()).unwrap();
    let JpegImage { width, height, components, bits, samples: numbers } = &picture;
    assert_eq!((*width, *height, *components, *bits, numbers.len()), (13, 9, 1, 12, 117));
    let expected = |x: usize| {
        let wave = ((2 * x + 1) as f64 * PI / 16.0).cos() * 80.0 / 32f64.sqrt();
        (2048.0 + 200.0 / 8.0 + wave).round() as u16
    };
    for (at, &number) in numbers.iter().enumerate() {
        match (at % 13, at / 13) {
            (x @ 0..8, 0..8) => assert_eq!(number, expected(x), "{at}"),
            (_, 0..8) => assert_eq!(number, 2048 - 50),
            // 7800 steps, with small AC terms added.
            (0..8, _) => assert!(number.abs_diff(2048 + 1950) < 8, "{number}"),
            _ => assert_eq!(number, 2048 - 1800),
        }
    }
}

#[test]
fn components_may_have_fewer_samples_and_scans_of_their_own() {
    let picture = decode(&colors()).unwrap();
    let pixel = |x: usize, y: usize| {
        [0, 1, 2].map(|place| i32::from(picture.samples[(20 * y + x) * 3 + place]) - 2048)
    };
    assert_eq!(
        header(&colors()).unwrap(),
        JpegFrameHeader { width: 20, height: 9, components: 3, bits: 12, is_extended: true }
    );
    assert_eq!(
        [pixel(0, 0), pixel(7, 7), pixel(8, 0), pixel(15, 7)],
        [[1, 1, -1], [1, 1, -1], [2, 1, -1], [2, 1, -1]]
    );
    assert_eq!([pixel(16, 0), pixel(19, 7)], [[-1, 3, 100]; 2]);
    assert_eq!([pixel(0, 8), pixel(8, 8), pixel(16, 8)], [[10, 1, -10], [20, 1, -10], [20, 4, 0]]);
}

#[test]
fn what_is_not_sequential_is_refused() {
    for (marker, bits, size, factors, words) in [
        (0xc2, 8, [8, 8], &[0x11][..], "progressive"),
        (0xc3, 8, [8, 8], &[0x11], "lossless"),
        (0xc5, 8, [8, 8], &[0x11], "hierarchical"),
        (0xc9, 8, [8, 8], &[0x11], "arithmetic"),
        (0xc1, 10, [8, 8], &[0x11], "10 bits"),
        (0xc1, 12, [8, 0], &[0x11], "8 x 0 pixels"),
        (0xc1, 12, [8, 8], &[0x51], "not supported"),
        (0xc1, 12, [8, 8], &[0x11; 5], "5 samples"),
    ] {
        let packed = stream(&[frame(marker, bits, size, factors), scan(&[1], &[(0, &[])])]);
        let refused = [header(&packed).unwrap_err(), decode(&packed).unwrap_err()];
        assert!(refused.iter().all(|refused| refused.contains(words)), "{refused:?}");
    }
    for (parts, words) in [
        (vec![frame(0xc1, 12, [8, 8], &[0x11]), scan(&[1], &[(0, &[])])], "table"),
        (vec![tables(), frame(0xc1, 12, [8, 8], &[0x11]), scan(&[2], &[(0, &[])])], "components"),
        (vec![tables(), frame(0xc1, 12, [65535, 65535], &[0x11]), scan(&[1], &[(0, &[])])], "truncated"),
        (vec![frame(0xc1, 12, [8, 8], &[0x11]); 2], "two frame headers"),
        (vec![tables(), frame(0xc1, 12, [8, 8], &[0x11]), scan(&[1], &[(0, &[(15, 0); 4])])], "outside"),
        (vec![segment(0xdb, &[0; 64])], "table"),
    ] {
        let refused = decode(&stream(&parts)).unwrap_err();
        assert!(refused.contains(words), "{refused}");
    }
    assert!(header(b"GIF").unwrap_err().contains("does not begin"));
}

#[test]
fn damage_is_refused_or_read() {
    for good in [grey(), colors()] {
        let whole = decode(&good).unwrap();
        // The EOI marker is optional, but each byte before it is needed.
        for end in 0..good.len() - 2 {
            assert!(decode(&good[..end]).is_err(), "{end}");
        }
        let mut bad = good.clone();
        for at in 0..good.len() {
            for value in [0, 1, 0x11, 0x7f, 0xff, good[at] ^ 1, good[at] ^ 0x80, good[at].wrapping_add(1)] {
                bad[at] = value;
                if header(&bad).is_ok_and(|header| header.width * header.height < 1 << 20) {
                    let numbers = decode(&bad).map_or(Vec::new(), |picture| picture.samples);
                    assert!(numbers.iter().all(|number| *number < 1 << 12), "{at} {value}");
                }
            }
            bad[at] = good[at];
        }
        assert_eq!(decode(&bad), Ok(whole));
    }
}
