//! The name of a scene's view, for changes of what it states.

/// The name of the view of a scene's text: as stated, or what a view without a name is called.
pub fn view_name(text: &str) -> String {
    let scene: toml::Table = text.parse().unwrap_or_default();
    let entities =
        scene.get("entity").and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
    let name = |entity: &toml::Value| Some(entity.get("name")?.as_str()?.to_owned());
    let view = entities.iter().find(|entity| entity.get("view").is_some());
    let numbered = (2_u32..).map(|number| format!("observer {number}"));
    let mut default = std::iter::once("observer".to_owned()).chain(numbered);
    let free =
        |default: &String| !entities.iter().any(|entity| name(entity).as_ref() == Some(default));
    view.and_then(name).or_else(|| default.find(free)).unwrap_or_default()
}
