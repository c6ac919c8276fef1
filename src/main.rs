//! The `auxetica` command.

fn main() -> std::process::ExitCode {
    auxetica::cli::main()
}
