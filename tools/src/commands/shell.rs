//! Help for shells: `completions` and `man`.

use std::fs;
use std::path::PathBuf;

use anyhow::Context as _;
use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

use super::print;
use crate::arguments::Command;

#[derive(Args, Debug)]
pub(crate) struct Completions {
    /// Shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

#[derive(Args, Debug)]
pub(crate) struct Man {
    /// Folder for the pages of all commands, such as ~/.local/share/man/man1 [default: print the first page]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(super) fn completions(Completions { shell }: &Completions) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(*shell, &mut Command::command(), "sunfleck", &mut script);
    print(&String::from_utf8_lossy(&script))
}

pub(super) fn man(Man { out }: &Man) -> anyhow::Result<()> {
    let command = Command::command();
    let Some(folder) = out else {
        let mut page = Vec::new();
        clap_mangen::Man::new(command).render(&mut page).context("cannot write the page")?;
        return print(&String::from_utf8_lossy(&page));
    };
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    clap_mangen::generate_to(command, folder)
        .with_context(|| format!("cannot write pages into {}", folder.display()))?;
    print(&format!("{}: a page for each command, sunfleck.1 the first\n", folder.display()))
}
