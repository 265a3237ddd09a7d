//! Builds the C++ library, which the package carries, by CMake; or links an installed one: see docs/rust.md.
use std::path::{Path, PathBuf};
use std::process::{exit, Command, Stdio};
use std::{env, fs};

const NEEDED: &str = "\
The crate broadside builds a C++20 library. This takes CMake 3.22, make or Ninja, a C++ compiler (g++ 12, clang 14, MSVC
2022 or newer) and Highway, a library for SIMD:
  Debian, Ubuntu: apt-get install cmake g++ make libhwy-dev
  macOS:          brew install cmake highway
  Windows:        vcpkg install highway, and set CMAKE_TOOLCHAIN_FILE to vcpkg's vcpkg.cmake
CXX, CXXFLAGS, CMAKE_PREFIX_PATH and CMAKE_GENERATOR say where they are and which to take. Or set BROADSIDE_LIB_DIR to
the folder of an installed library, which has pkgconfig/broadside.pc.";

fn fail(reason: &str, help: &str) -> ! {
    eprintln!("error: {reason}\n\n{help}");
    exit(1);
}

/// Runs a command and returns what it prints to stdout, if that is a pipe. Exits if it fails; Cargo then shows the rest.
fn run(command: &mut Command, stdout: Stdio, help: &str) -> String {
    let output = match command.stdout(stdout).stderr(Stdio::inherit()).output() {
        Ok(output) => output,
        Err(error) => fail(&format!("{:?} could not be run: {error}", command.get_program()), help),
    };
    if !output.status.success() {
        fail(&format!("{command:?} failed; Cargo shows its output"), help);
    }
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Links an installed library, by its pkg-config file.
fn link_installed(folder: &str) {
    let help =
        "BROADSIDE_LIB_DIR is the lib folder of an installed library: see docs/packaging.md. This takes pkg-config.";
    let file = Path::new(folder).join("pkgconfig");
    let mut command = Command::new("pkg-config");
    command.args(["--libs", "broadside"]).env("PKG_CONFIG_PATH", file);
    println!("cargo:rustc-link-search=native={folder}");
    for flag in run(&mut command, Stdio::piped(), help).split_whitespace() {
        if let Some(folder) = flag.strip_prefix("-L") {
            println!("cargo:rustc-link-search=native={folder}");
        } else if let Some(name) = flag.strip_prefix("-l") {
            println!("cargo:rustc-link-lib={name}");
        }
    }
}

/// Links a library file: libhwy.a, libhwy.so.1.0.3, hwy.lib, ...
fn link_file(path: &Path) {
    let file = path.file_name().and_then(|name| name.to_str()).expect("CMake writes whole paths");
    let stem = file.split('.').next().unwrap();
    let is_static = file.ends_with(".a");
    let name = if file.ends_with(".lib") { stem } else { stem.strip_prefix("lib").unwrap_or(stem) };
    println!("cargo:rustc-link-search=native={}", path.parent().unwrap().display());
    println!("cargo:rustc-link-lib={}{name}", if is_static { "static=" } else { "" });
}

fn build(root: &Path) {
    let folder = PathBuf::from(env::var_os("OUT_DIR").unwrap()).join("cmake");
    // CMake would take the compiler and the flags of the last build from it.
    let _ = fs::remove_file(folder.join("CMakeCache.txt"));
    run(
        Command::new("cmake")
            .arg("-S")
            .arg(root.join("bindings/rust"))
            .arg("-B")
            .arg(&folder)
            .arg("-DCMAKE_BUILD_TYPE=Release"),
        Stdio::inherit(),
        NEEDED,
    );
    let jobs = env::var("NUM_JOBS").unwrap_or_else(|_| "1".into());
    let target = ["--target", "broadside", "--config", "Release", "--parallel", &jobs];
    run(Command::new("cmake").arg("--build").arg(&folder).args(target), Stdio::inherit(), NEEDED);
    let files = fs::read_to_string(folder.join("link-Release.txt")).expect("CMake has written it");
    for file in files.lines() {
        link_file(Path::new(file));
    }
    // The standard library of C++.
    let target = env::var("TARGET").unwrap();
    if target.contains("apple") || target.contains("freebsd") {
        println!("cargo:rustc-link-lib=c++");
    } else if !target.contains("msvc") {
        println!("cargo:rustc-link-lib=stdc++");
    }
}

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap());
    for path in ["CMakeLists.txt", "bindings/c", "bindings/rust/CMakeLists.txt", "cmake", "include", "src"] {
        println!("cargo:rerun-if-changed={}", root.join(path).display());
    }
    for name in [
        "DOCS_RS",
        "BROADSIDE_LIB_DIR",
        "CXX",
        "CXXFLAGS",
        "CMAKE_PREFIX_PATH",
        "CMAKE_GENERATOR",
        "CMAKE_TOOLCHAIN_FILE",
    ] {
        println!("cargo:rerun-if-env-changed={name}");
    }
    if env::var_os("DOCS_RS").is_some() {
        return; // documentation links nothing
    }
    let is_cross = env::var("TARGET") != env::var("HOST");
    let is_set = |name: &str| env::var_os(name).is_some();
    if is_cross && !["BROADSIDE_LIB_DIR", "CMAKE_TOOLCHAIN_FILE", "CXX"].iter().any(|name| is_set(name)) {
        fail(
            &format!("the target is {}, and the host {}", env::var("TARGET").unwrap(), env::var("HOST").unwrap()),
            "To cross-compile, set CXX to a compiler for the target, CMAKE_TOOLCHAIN_FILE to a toolchain file of CMake, \
             or BROADSIDE_LIB_DIR to the folder of a library for it. In WebAssembly, use the npm package.",
        );
    }
    match env::var("BROADSIDE_LIB_DIR") {
        Ok(folder) => link_installed(&folder),
        Err(_) => build(&root),
    }
}
