//! Embeds the folder anew whenever a file in it is added, changed or removed.

fn main() {
    println!("cargo::rerun-if-changed=.");
}
