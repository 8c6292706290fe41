//! Commented definitions to begin with, which the program carries along.

/// A definition to begin with: its name, which is also that of its sweep, and its text.
pub type Template = (&'static str, &'static str);

/// All of them.
const TEMPLATES: [Template; 7] = [
    ("paper", include_str!("../../../sweeps/paper.toml")),
    ("smoke", include_str!("../../../sweeps/smoke.toml")),
    ("glove", include_str!("../../../sweeps/glove.toml")),
    ("gaps", include_str!("../../../sweeps/gaps.toml")),
    ("imperfection", include_str!("../../../sweeps/imperfection.toml")),
    ("paper-as-written", include_str!("../../../sweeps/paper-as-written.toml")),
    ("paper-neo-hookean", include_str!("../../../sweeps/paper-neo-hookean.toml")),
];

/// The names of all templates.
pub fn names() -> [&'static str; TEMPLATES.len()] {
    TEMPLATES.map(|(name, _)| name)
}

/// The template of that name, as the definition of the sweep `name` in `file`.
pub fn text(template: &str, name: &str, file: &str) -> Option<String> {
    let (known, text) = TEMPLATES.iter().find(|(known, _)| *known == template)?;
    let text = text.replace(&format!("name = \"{known}\""), &format!("name = \"{name}\""));
    let text = text.replace(&format!("results/{known}/"), &format!("results/{name}/"));
    Some(text.replace(&format!("sweeps/{known}.toml"), file))
}
