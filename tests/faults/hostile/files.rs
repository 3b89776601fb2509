//! Hostile files for all readers of the command line. A new reader adds a line to [`all_hostile_files`]. Transfer
//! functions of other programs are opened in the window only, where mutations and `fuzz/` test their readers.

use std::ffi::OsString;
use std::io::Write as _;
use std::path::Path;

use chiaroscuro_media::export_png;
use chiaroscuro_scene::{LookRecord, Settings};

/// Hostile file, and the command that reads it.
pub(super) struct HostileFile {
    pub(super) name: String,
    pub(super) args: Vec<OsString>,
}

/// Writes hostile files of every kind into a folder; `forbidden` is another folder, from which nothing may be opened.
pub(super) fn all_hostile_files(folder: &Path, forbidden: &Path) -> Vec<HostileFile> {
    let mut made = HostileFileMaker { folder, files: Vec::new() };
    let names = hostile_names(folder, forbidden);
    made.add_nrrd_headers(&names);
    made.add_headerless_files();
    made.add_looks(&names);
    made.files
}

/// File names that lead out of a folder, or to something that is no file.
pub(super) fn hostile_names(folder: &Path, forbidden: &Path) -> Vec<String> {
    let target = forbidden.join("voxels.raw");
    #[cfg(unix)]
    for (link, to) in [("link.raw", target.as_path()), ("link", forbidden)] {
        std::os::unix::fs::symlink(to, folder.join(link)).expect("links can be made");
    }
    let up = forbidden.file_name().expect("a name").to_string_lossy();
    let absolute = target.display();
    [
        "link.raw",
        "link/voxels.raw",
        "",
        ".",
        "..",
        "/",
        "/dev/zero",
        "/dev/stdin",
        "/proc/self/mem",
        "/proc/self/environ",
        "\\\\server\\share\\voxels.raw",
        "//server/share/voxels.raw",
        "C:\\voxels.raw",
        "C:voxels.raw",
        "CON",
        "http://127.0.0.1:9/voxels.raw",
        "~/voxels.raw",
        "$HOME/voxels.raw",
        "a\u{0}b.raw",
        "LIST",
        "voxels%03d.raw 1 9 1",
        "\u{202e}war.slexov",
    ]
    .map(str::to_owned)
    .into_iter()
    .chain([
        format!("../{up}/voxels.raw"),
        format!("./x/../../{up}/voxels.raw"),
        format!("..\\{up}\\voxels.raw"),
        format!("{absolute}"),
        format!("file://{absolute}"),
        "x/".repeat(3000),
        "x".repeat(300),
    ])
    .collect()
}

/// Decompression bomb: small gzip data that expand to many mebibytes of zeros.
fn gzip_bomb(mebibytes: usize) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    let zeros = vec![0; 1 << 20];
    for _ in 0..mebibytes {
        encoder.write_all(&zeros).expect("it is in memory");
    }
    encoder.finish().expect("it is in memory")
}

struct HostileFileMaker<'a> {
    folder: &'a Path,
    files: Vec<HostileFile>,
}

impl HostileFileMaker<'_> {
    /// Adds a file and the command that reads it, in which `@` is its name.
    fn add(&mut self, name: &str, contents: &[u8], command: &str) {
        let file = format!("{:03}_{name}", self.files.len());
        std::fs::write(self.folder.join(&file), contents).expect("room");
        let args = command.split(' ').map(|word| if word == "@" { file.clone() } else { word.to_owned() });
        self.files.push(HostileFile { name: file.clone(), args: args.map(OsString::from).collect() });
    }

    fn add_nrrd(&mut self, fields: &str, data: &[u8]) {
        let header = format!("NRRD0004\n{fields}\n\n");
        self.add("volume.nrrd", &[header.as_bytes(), data].concat(), "info @");
    }

    /// Adds NRRD files with hostile headers.
    fn add_nrrd_headers(&mut self, names: &[String]) {
        for name in names {
            let header = format!(
                "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\ndata file: {name}\n"
            );
            self.add("header.nhdr", header.as_bytes(), "info @");
        }
        let usual = "type: uint8\ndimension: 3\nencoding: raw";
        for sizes in [
            "",
            "8 8",
            "8 8 8 8",
            "0 8 8",
            "-8 8 8",
            "8.5 8 8",
            "nan 8 8",
            "1e3 8 8",
            "4294967296 4294967296 1",
            "18446744073709551615 1 1",
            "18446744073709551616 1 1",
            "1000000 1000000 1000000",
            "1 1 99999999999999999999999999999999999999",
            "2147483647 2147483647 2147483647",
        ] {
            self.add_nrrd(&format!("{usual}\nsizes: {sizes}"), &[0; 64]);
        }
        for field in [
            "spacings: 0 0 0",
            "spacings: nan inf -inf",
            "spacings: 1e308 1e308 1e308",
            "spacings: 1e-320 1 1",
            "space directions: (0,0,0) (0,0,0) (0,0,0)",
            "space directions: (1e308,0,0) (0,1e308,0) (0,0,1e308)",
            "space directions: (1,0,0) (1,0,0) (1,0,0)",
            "space directions: (nan,0,0) none (",
            "space origin: (1e308,1e308,1e308)",
            "byte skip: -2",
            "byte skip: 9223372036854775807",
            "line skip: 9223372036854775807",
            "encoding: hex",
            "encoding: bzip2",
            "encoding: nonsense",
            "type: block",
            "block size: 99999999999",
            "dimension: 17",
            "dimension: -1",
            "sizes: 4 4 4",
            "content: \u{1b}[2J\u{1b}]0;title\u{7}",
            "kinds: \u{202e} \u{0} x",
        ] {
            self.add_nrrd(&format!("{usual}\nsizes: 4 4 4\n{field}"), &[0; 64]);
        }
        self.add_nrrd(&format!("{usual}\nsizes: 4 4 4\ncontent: {}", "x".repeat(2 << 20)), &[0; 64]);
        self.add_nrrd(&format!("{usual}\nsizes: 4 4 4{}", "\nkey:=value".repeat(200_000)), &[0; 64]);
        let zipped = usual.replace("raw", "gzip");
        for sizes in ["4 4 4", "1024 1024 1024", "100000 100000 100"] {
            self.add_nrrd(&format!("{zipped}\nsizes: {sizes}"), &gzip_bomb(64));
        }
        let valid = gzip_bomb(1);
        self.add_nrrd(&format!("{zipped}\nsizes: 1024 1024 1"), &valid[..valid.len() / 2]);
        self.add_nrrd(&format!("{zipped}\nsizes: 1024 1024 1"), b"\x1f\x8b\x08nothing");
        self.add("empty.nrrd", b"", "info @");
        self.add("endless.nrrd", &vec![b'N'; 1 << 20], "info @");
        self.add("binary.nrrd", &[&b"NRRD0004\n"[..], &[0xff; 4096]].concat(), "info @");
    }

    /// Adds files without a header, whose names or options state their layout.
    fn add_headerless_files(&mut self) {
        for size in ["99999999x99999999x99999999", "0x0x0", "1x1x18446744073709551616", "-1x8x8", "8x8", "x"]
        {
            self.add(&format!("{size}_uint8.raw"), &[0; 512], "info @");
            self.add("bare.raw", &[0; 512], &format!("info @ --dims {size} --type uint8"));
        }
        for skip in ["18446744073709551615", "-1", "513"] {
            self.add("bare.raw", &[0; 512], &format!("info @ --dims 8x8x8 --type uint8 --offset {skip}"));
        }
        for kind in ["uint8", "float64"] {
            self.add(&format!("8x8x8_{kind}.raw.gz"), &gzip_bomb(256), "info @");
        }
    }

    /// Adds sessions, presets and pictures with a look.
    fn add_looks(&mut self, names: &[String]) {
        for name in names {
            let source = serde_json::to_string(name).expect("a text");
            let record = LookRecord::to_json(&Settings::default(), None, None);
            let with_source = record.replacen('{', &format!("{{\"volume\": {{\"source\": {source}}},"), 1);
            self.add_picture(&with_source);
        }
        let long = "x".repeat(1 << 19);
        let texts = [
            String::new(),
            "{".to_owned(),
            "null".to_owned(),
            "[]".to_owned(),
            "{\"schema\": -1}".to_owned(),
            "{\"schema\": 99999999999999999999}".to_owned(),
            "{\"schema\": \"one\"}".to_owned(),
            "{\"schema\": 1, \"camera\": null, \"lights\": null}".to_owned(),
            "{\"schema\": 1, \"camera\": {\"distance\": 1e999}}".to_owned(),
            "{\"schema\": 1, \"camera\": {\"azimuth_deg\": NaN}}".to_owned(),
            format!("{{\"schema\": 1, \"views\": {{\"{long}\": {{}}}}}}"),
            format!("{{\"schema\": 1, \"lights\": [{}{{}}]}}", "{},".repeat(50_000)),
            format!("{{\"schema\": 1, \"lights\": [{{\"name\": \"{long}\"}}]}}"),
            format!("{{\"schema\": 1, \"transfer\": {{\"points\": [{}{{}}]}}}}", "{},".repeat(50_000)),
            "[".repeat(100_000),
            "{\"a\":".repeat(100_000),
            "\u{feff}{\"schema\": 1}".to_owned(),
            "{\"schema\": 1}\u{0}\u{0}".to_owned(),
            " ".repeat(3 << 20),
        ];
        for text in &texts {
            self.add_look("session.json", text);
            if text.len() < 1 << 20 {
                self.add_picture(text);
            }
        }
        let png = std::fs::read(self.folder.join(&self.files[self.files.len() - 2].name)).unwrap_or_default();
        for length in [0, 1, 8, 20, 33, png.len() / 2, png.len().saturating_sub(1)] {
            self.add("cut.png", &png[..length], "replay @");
            self.add("cut.exr", &png[..length], "replay @");
        }
    }

    fn add_look(&mut self, name: &str, text: &str) {
        self.add(
            name,
            text.as_bytes(),
            "render builtin:sphere:8 --size 8x8 --force -o shown.png --session @",
        );
    }

    /// Adds a picture with a text as its look.
    fn add_picture(&mut self, record: &str) {
        let path = self.folder.join("made.png");
        export_png([2, 2], &[9; 16], true, Some(record), &path).expect("a picture");
        let bytes = std::fs::read(&path).expect("it was just written");
        self.add("picture.png", &bytes, "replay @");
    }
}
