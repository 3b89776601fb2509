//! MP4 video, encoded by an installed ffmpeg: encoders are large, and some are patented.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufWriter, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};

use super::embedded_record::append_to_mp4;
use super::{AnimationEncoder, AnimationSpec};
use crate::ExportError;
use crate::png_file::rgb;
use chiaroscuro_files::{
    TemporaryFile, provenance_mark, rename_into_place, temporary_file_for, unnamed_file,
};

/// Options for x264: low loss, which smooth shading needs.
const X264_OPTIONS: [&str; 4] = ["-c:v", "libx264", "-crf", "16"];

/// Options for any other MP4 encoder.
const FALLBACK_OPTIONS: [&str; 2] = ["-q:v", "2"];

/// Colour conversion to BT.709, limited range, 4:2:0.
const COLOUR_FILTER: &str = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";

/// Maximum number of bytes read of ffmpeg's error output.
const MAX_ERROR_BYTES: u64 = 1 << 16;

/// Returns ffmpeg's filter graph. Players require even edges, so odd ones are extended by repeating a pixel.
fn filter([width, height]: [u32; 2]) -> String {
    let (right, bottom) = (width % 2, height % 2);
    if (right, bottom) == (0, 0) {
        return COLOUR_FILTER.to_owned();
    }
    let wider = format!("pad={}:{}", width + right, height + bottom);
    format!("{wider},fillborders=right={right}:bottom={bottom}:mode=smear,{COLOUR_FILTER}")
}

/// Running ffmpeg process, which is killed when this is dropped.
struct FfmpegProcess {
    child: Child,
    frames: Option<BufWriter<ChildStdin>>,
    /// Error output of ffmpeg: a file, since a full pipe would block it.
    error_output: File,
}

impl Drop for FfmpegProcess {
    fn drop(&mut self) {
        self.frames = None;
        // It has already ended, unless the video was abandoned.
        if let Err(err) = self.child.kill().and_then(|()| self.child.wait()) {
            log::warn!("ffmpeg could not be stopped: {err}");
        }
    }
}

impl FfmpegProcess {
    /// Returns the reason of a failure: ffmpeg's last message, or `otherwise` if there is none.
    fn failure(&mut self, path: &Path, otherwise: &str) -> ExportError {
        self.frames = None;
        // The message is complete only when the process has ended.
        let status = self.child.wait().map_or_else(|err| err.to_string(), |status| status.to_string());
        let mut said = Vec::new();
        let read = self
            .error_output
            .rewind()
            .and_then(|()| (&mut self.error_output).take(MAX_ERROR_BYTES).read_to_end(&mut said));
        let said = String::from_utf8_lossy(if read.is_ok() { &said } else { &[] }).into_owned();
        let last = said.lines().map(str::trim).rfind(|line| !line.is_empty());
        let said = last.map_or_else(|| format!("{otherwise} ({status})"), str::to_owned);
        ExportError::Ffmpeg { path: path.to_owned(), said }
    }
}

/// Writer of an MP4 through ffmpeg.
pub(super) struct Mp4Writer {
    ffmpeg: FfmpegProcess,
    file: TemporaryFile,
    path: PathBuf,
    remaining_frames: u32,
    /// Record of the first frame.
    record: String,
}

impl Mp4Writer {
    /// Starts ffmpeg, whose executable is `program`.
    pub(super) fn create(
        path: &Path,
        animation_spec: &AnimationSpec,
        program: &OsStr,
    ) -> Result<Self, ExportError> {
        if animation_spec.transparent {
            let what = "MP4 has no transparency; use PNG or GIF, or keep the background";
            return Err(ExportError::UnsupportedByFormat { what, path: path.to_owned() });
        }
        let not_there =
            |source| ExportError::NoFfmpeg { program: program.to_string_lossy().into_owned(), source };
        let known = Command::new(program).args(["-v", "error", "-encoders"]).output().map_err(not_there)?;
        let has_x264 = String::from_utf8_lossy(&known.stdout).contains(" libx264 ");
        let file = temporary_file_for(path)?;
        let words = unnamed_file().map_err(ExportError::io_error_for(path))?;
        let [width, height] = animation_spec.size;
        let mut child = Command::new(program)
            .args(["-v", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"])
            .args([
                "-s",
                &format!("{width}x{height}"),
                "-r",
                &animation_spec.rate.to_string(),
                "-i",
                "-",
                "-an",
            ])
            .args([
                "-vf",
                &filter(animation_spec.size),
                "-colorspace",
                "bt709",
                "-color_primaries",
                "bt709",
                "-color_trc",
                "bt709",
            ])
            .args(if has_x264 { &X264_OPTIONS[..] } else { &FALLBACK_OPTIONS[..] })
            // The header comes first, so that players can start before the file is complete.
            .args([
                "-movflags",
                "+faststart",
                "-metadata",
                &format!("comment={}", provenance_mark()),
                "-f",
                "mp4",
                "-y",
            ])
            .arg(file.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(words.try_clone().map_err(ExportError::io_error_for(path))?)
            .spawn()
            .map_err(not_there)?;
        let frames = child.stdin.take().map(BufWriter::new);
        let ffmpeg = FfmpegProcess { child, frames, error_output: words };
        Ok(Self {
            ffmpeg,
            file,
            path: path.to_owned(),
            remaining_frames: animation_spec.frames,
            record: String::new(),
        })
    }
}

impl AnimationEncoder for Mp4Writer {
    fn add(&mut self, shown: &[u8], record: &str) -> Result<(), ExportError> {
        if self.record.is_empty() {
            record.clone_into(&mut self.record);
        }
        self.remaining_frames = self.remaining_frames.saturating_sub(1);
        match self.ffmpeg.frames.as_mut().map(|frames| frames.write_all(&rgb(shown))) {
            Some(Ok(())) => Ok(()),
            Some(Err(err)) => Err(self.ffmpeg.failure(&self.path, &err.to_string())),
            None => Err(self.ffmpeg.failure(&self.path, "it accepts no more frames")),
        }
    }

    fn finish(self: Box<Self>) -> Result<(), ExportError> {
        let Self { mut ffmpeg, file, path, remaining_frames: missing, record } = *self;
        if missing > 0 {
            return Err(ExportError::UnsupportedByFormat { what: "frames are missing", path });
        }
        if let Some(Err(err)) = ffmpeg.frames.take().map(|mut frames| frames.flush()) {
            return Err(ffmpeg.failure(&path, &err.to_string()));
        }
        // The process ends when its input is closed.
        let ended = ffmpeg.child.wait().map_err(ExportError::io_error_for(&path))?;
        let length = file.as_file().metadata().map_err(ExportError::io_error_for(&path))?.len();
        if !ended.success() || length == 0 {
            return Err(ffmpeg.failure(&path, "it wrote nothing"));
        }
        if !record.is_empty() {
            let mut end = file.reopen().map_err(ExportError::io_error_for(&path))?;
            let appended = end.seek(SeekFrom::End(0)).and_then(|_| append_to_mp4(&mut end, &record));
            appended.map_err(ExportError::io_error_for(&path))?;
        }
        Ok(rename_into_place(file, &path)?)
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    const ANIMATION_SPEC: AnimationSpec =
        AnimationSpec { size: [3, 2], frames: 2, rate: 24, transparent: false };

    /// Creates a stand-in for ffmpeg: it lists its encoders, then runs `script` with the video's name in $last.
    fn stand_in(folder: &Path, script: &str) -> PathBuf {
        let path = folder.join("stand-in");
        let head =
            "#!/bin/sh\nfor last; do :; done\n[ \"$last\" = -encoders ] && { echo ' V libx264 x'; exit; }\n";
        std::fs::write(&path, format!("{head}{script}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    fn make(folder: &Path, program: &Path) -> Result<(), ExportError> {
        let mut file =
            Box::new(Mp4Writer::create(&folder.join("a.mp4"), &ANIMATION_SPEC, program.as_os_str())?);
        for at in 0..2 {
            file.add(&[at; 24], "")?;
        }
        file.finish()
    }

    #[test]
    fn ffmpeg_gets_every_picture_and_its_video_takes_the_name() {
        let folder = tempfile::tempdir().unwrap();
        let program = stand_in(folder.path(), "echo \"$@\" | tr ' ' '\\n' > \"$0.said\"; cat > \"$last\"");
        make(folder.path(), &program).unwrap();
        let video = std::fs::read(folder.path().join("a.mp4")).unwrap();
        assert_eq!(video, [[0; 18], [1; 18]].concat(), "without alpha");
        let said = std::fs::read_to_string(folder.path().join("stand-in.said")).unwrap();
        let said: Vec<_> = said.lines().collect();
        for expected in [["-s", "3x2"], ["-r", "24"], ["-c:v", "libx264"]] {
            assert!(said.windows(2).any(|pair| pair == expected), "{expected:?} in {said:?}");
        }
    }

    #[test]
    fn odd_edges_are_continued() {
        assert_eq!(filter([640, 480]), COLOUR_FILTER);
        assert!(filter([321, 240]).starts_with("pad=322:240,fillborders=right=1:bottom=0:mode=smear,"));
    }

    #[test]
    fn failures_are_told_in_its_words_and_leave_nothing() {
        let folder = tempfile::tempdir().unwrap();
        for (script, word) in [
            ("echo 'no such codec' >&2; exit 1", "no such codec"),
            ("cat > /dev/null; echo 'disk full' >&2; exit 1", "disk full"),
            ("cat > /dev/null", "it wrote nothing"),
        ] {
            let program = stand_in(folder.path(), script);
            let err = make(folder.path(), &program).unwrap_err().to_string();
            assert!(err.contains(word) || err.contains("ipe"), "{script}: {err}");
        }
        let err = make(folder.path(), Path::new("/no/such/ffmpeg")).unwrap_err();
        assert!(matches!(err, ExportError::NoFfmpeg { .. }), "{err}");
        let transparent = AnimationSpec { transparent: true, ..ANIMATION_SPEC };
        assert!(Mp4Writer::create(&folder.path().join("a.mp4"), &transparent, "ffmpeg".as_ref()).is_err());
        // An abandoned process is ended.
        let program = stand_in(folder.path(), "cat > \"$last\"");
        let mut short =
            Mp4Writer::create(&folder.path().join("a.mp4"), &ANIMATION_SPEC, program.as_os_str()).unwrap();
        short.add(&[0; 24], "").unwrap();
        drop(short);
        let left: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left, ["stand-in"]);
    }
}
