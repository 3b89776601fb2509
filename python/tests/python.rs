//! Runs the tests of the Python package with the module that this build has made.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Advice if the tests cannot be run.
const HELP: &str = "`script/test` installs what they need";

/// Copies the package with the native module, as a wheel would lay them out, and returns the folder that holds it.
fn package_folder(module: &Path) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-package");
    let package = folder.join("chiaroscuro");
    fs::create_dir_all(&package).expect("the folder of the package can be made");
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("chiaroscuro");
    for entry in fs::read_dir(sources).expect("the package can be listed") {
        let path = entry.expect("the package can be listed").path();
        if path.is_file() {
            fs::copy(&path, package.join(path.file_name().expect("a name")))
                .expect("the package can be copied");
        }
    }
    fs::copy(module, package.join("_native.abi3.so")).expect("the module can be copied");
    folder
}

#[test]
fn tests_of_the_package() {
    let own = env::current_exe().expect("the test has a path");
    let deps = own.parent().expect("the test is in a folder");
    let name = format!("{}chiaroscuro_python{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    let module = deps.join(&name);
    assert!(module.exists(), "{} was not built", module.display());
    let program = deps.with_file_name(format!("chiaroscuro{}", env::consts::EXE_SUFFIX));
    let package = package_folder(&module);
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let further =
        env::var_os("PYTHONPATH").into_iter().flat_map(|paths| env::split_paths(&paths).collect::<Vec<_>>());
    let paths = env::join_paths([package.clone()].into_iter().chain(further)).expect("paths without colons");
    let python = env::var_os("PYTHON").unwrap_or_else(|| "python3".into());
    let done = Command::new(&python)
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--doctest-modules"])
        .args([&tests, &package.join("chiaroscuro")])
        // It has no examples, and needs packages for notebooks.
        .arg(format!("--ignore={}", package.join("chiaroscuro/_notebook.py").display()))
        .current_dir(&package)
        .env("PYTHONPATH", paths)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("CHIAROSCURO_PROGRAM", program)
        .status()
        .unwrap_or_else(|err| panic!("{} cannot be run: {err}; {HELP}", python.display()));
    assert!(
        done.success(),
        "tests of the Python package failed ({done}), or NumPy, Pillow or pytest is missing; {HELP}"
    );
}
