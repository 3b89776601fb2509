//! Separately compressed parts of files, strips of TIFF and blocks of VTK, that announce far more than they contain,
//! or contain far more than they announce.

use super::BrokenVolumeMaker;

/// Announced size with almost no data behind it, in bytes: more than any refusal may need.
const ANNOUNCED_BYTES: u32 = 1 << 30;

/// Largest block of Zstandard, in bytes.
const ZSTD_BLOCK: u32 = 128 << 10;

pub(super) fn add_packed_parts(made: &mut BrokenVolumeMaker) {
    add_tiff_strips(made);
    add_vtk_blocks(made);
}

/// Zstandard frame whose blocks repeat a byte; its window is `2^(10 + exponent)` bytes.
fn zstd_rle_frame(exponent: u8, blocks: u32, is_ended: bool) -> Vec<u8> {
    let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd, 0, exponent << 3];
    for at in 1..=blocks {
        // Size, block type RLE, and the flag of the last block.
        let header = ZSTD_BLOCK << 3 | 1 << 1 | u32::from(is_ended && at == blocks);
        frame.extend(&header.to_le_bytes()[..3]);
        frame.push(7);
    }
    frame
}

/// TIFF file of one page of bytes, with the offsets and lengths of its strips.
fn tiff_page(
    [width, height]: [u32; 2],
    compression: u32,
    rows: u32,
    strips: &[[u32; 2]],
    data: &[u8],
) -> Vec<u8> {
    // Offsets count from the data on, which follow the header of 8 bytes.
    let mut file = [b"II*\0".to_vec(), vec![0; 4], data.to_vec()].concat();
    let mut place = |numbers: Vec<u32>| {
        if let [one] = numbers[..] {
            return one;
        }
        let at = file.len() as u32;
        file.extend(numbers.into_iter().flat_map(u32::to_le_bytes));
        at
    };
    let count = strips.len() as u32;
    let offsets = place(strips.iter().map(|strip| 8 + strip[0]).collect());
    let lengths = place(strips.iter().map(|strip| strip[1]).collect());
    let at = file.len() as u32;
    file[4..8].copy_from_slice(&at.to_le_bytes());
    let entries = [
        [256, 1, width],
        [257, 1, height],
        [258, 1, 8],
        [259, 1, compression],
        [262, 1, 1],
        [273, count, offsets],
        [278, 1, rows],
        [279, count, lengths],
    ];
    file.extend((entries.len() as u16).to_le_bytes());
    for [tag, count, value] in entries {
        // All entries are four-byte integers.
        file.extend([(tag as u16).to_le_bytes(), 4u16.to_le_bytes()].concat());
        file.extend([count, value].map(u32::to_le_bytes).concat());
    }
    file.extend([0; 4]);
    file
}

fn add_tiff_strips(made: &mut BrokenVolumeMaker) {
    let whole = |data: &[u8]| vec![[0, data.len() as u32]];
    let edge = ANNOUNCED_BYTES.isqrt();
    for exponent in [0, 13, 17, 18, 21, 31] {
        for (what, blocks, is_ended) in [
            ("one block", 1, true),
            ("blocks of 32 MiB", 256, true),
            ("blocks of 2 GiB", 16 << 10, true),
            ("blocks without an end", 300, false),
        ] {
            let frame = zstd_rle_frame(exponent, blocks, is_ended);
            for [width, height] in [[100, 100], [4096, 4096], [edge, edge]] {
                // A frame that fills a page of a gigabyte is a valid volume of a gigabyte.
                if u64::from(blocks) * u64::from(ZSTD_BLOCK) >= u64::from(ANNOUNCED_BYTES) && width == edge {
                    continue;
                }
                let what = format!("{what}, window 2^{}, {width} x {height} pixels", 10 + exponent);
                let file = tiff_page([width, height], 50000, height, &whole(&frame), &frame);
                made.add(what, "frame.tif", &file);
            }
        }
    }
    // The first of these frames does not fill the strip.
    let frames = zstd_rle_frame(0, 1, true).repeat(10_000);
    made.add("many frames", "frames.tif", &tiff_page([edge, edge], 50000, edge, &whole(&frames), &frames));
    // Sizes that every method can announce before its data turn out to be broken.
    let broken = [vec![0x80, 0x0b, 0x60, 0x50, 0x22], vec![0x55; 1 << 20]].concat();
    for compression in [1, 5, 8, 32773, 50000, 7] {
        for rows in [1, edge / 8, edge] {
            let count = edge.div_ceil(rows);
            let strips = vec![[0, broken.len() as u32 / count]; count as usize];
            let what = format!("compression {compression}, strips of {rows} rows");
            made.add(what, "announced.tif", &tiff_page([edge, edge], compression, rows, &strips, &broken));
        }
    }
    // Very many strips of the same bytes, each a row of one pixel.
    let same = vec![0x55; 128 << 10];
    for compression in [5, 8, 32773] {
        let strips = vec![[0, same.len() as u32]; 1 << 16];
        let what = format!("the same bytes over and over, compression {compression}");
        made.add(what, "same.tif", &tiff_page([1, 1 << 16], compression, 1, &strips, &same));
    }
}

fn add_vtk_blocks(made: &mut BrokenVolumeMaker) {
    let edge = 1024;
    let root = |compressor: &str, encoding: &str| {
        format!(
            "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\" header_type=\"UInt32\" compressor=\"{compressor}\">\
             <ImageData WholeExtent=\"1 {edge} 1 {edge} 1 {edge}\"><Piece Extent=\"1 {edge} 1 {edge} 1 {edge}\"><PointData>\
             <DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>\
             <AppendedData encoding=\"{encoding}\">_"
        )
    };
    // A literal run and a match that goes on as far as the bytes do; then one that refers to before the beginning.
    let long = [vec![0x1f, 7, 1, 0], vec![255; 5 << 20], vec![0, 0]].concat();
    let astray = [vec![0x1f, 7, 9, 0], vec![255; 5 << 20], vec![0, 0]].concat();
    for (compressor, data) in [
        ("vtkLZ4DataCompressor", vec![0x55; 100]),
        ("vtkLZ4DataCompressor", long[..1 << 20].to_vec()),
        ("vtkLZ4DataCompressor", astray),
        ("vtkZLibDataCompressor", vec![0x55; 100]),
        ("vtkZLibDataCompressor", vec![0x55; 5 << 20]),
    ] {
        for block in [ANNOUNCED_BYTES, ANNOUNCED_BYTES / 4] {
            let count = ANNOUNCED_BYTES / block;
            let each = data.len() as u32 / count;
            let header = [vec![count, block, 0], vec![each; count as usize]].concat();
            let header: Vec<u8> = header.into_iter().flat_map(u32::to_le_bytes).collect();
            let start = root(compressor, "raw");
            let file = [start.as_bytes(), &header, &data].concat();
            made.add(
                format!("{compressor}, blocks of {block} bytes, {} bytes", data.len()),
                "part.vti",
                &file,
            );
        }
    }
}
