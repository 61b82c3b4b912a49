//! KHR_lights_punctual. The extension's candela and lux are written as the scene's watts per steradian and per square metre: numbers are
//! kept, as in other renderers that work in radiometric units.

use super::error::within;
use super::{ExportError, Parts, named};
use aquifer_scene::{PunctualLight, PunctualShape, Scene};
use serde_json::{Value, json};
use std::f32::consts::FRAC_PI_2;

pub(super) fn write(scene: &Scene, parts: &mut Parts) -> Result<(), ExportError> {
    if scene.lights.is_empty() {
        return Ok(());
    }
    let lights = scene.lights.iter().map(object).collect::<Result<Vec<_>, _>>()?;
    parts.extensions.insert("KHR_lights_punctual");
    parts.root.insert("extensions".into(), json!({ "KHR_lights_punctual": { "lights": lights } }));
    Ok(())
}

fn object(light: &PunctualLight) -> Result<Value, ExportError> {
    let what = |part: &str| format!("{part} of light '{}'", light.name);
    for channel in light.intensity.to_array() {
        within(channel, [0.0, f32::MAX], || what("the intensity"))?;
    }
    // The colour's channels end at 1.
    let intensity = light.intensity.max_element();
    let color = if intensity > 0.0 { light.intensity / intensity } else { light.intensity };
    let mut object = named(&light.name);
    object.insert("color".into(), json!(color.to_array()));
    object.insert("intensity".into(), json!(intensity));
    if let Some(range) = light.range {
        within(range, [f32::MIN_POSITIVE, f32::MAX], || what("the range"))?;
        object.insert("range".into(), json!(range));
    }
    let kind = match light.shape {
        PunctualShape::Directional => "directional",
        PunctualShape::Point => "point",
        PunctualShape::Spot { inner, outer } => {
            within(outer, [f32::MIN_POSITIVE, FRAC_PI_2], || what("the outer half angle"))?;
            within(inner, [0.0, outer], || what("the inner half angle"))?;
            object.insert("spot".into(), json!({ "innerConeAngle": inner, "outerConeAngle": outer }));
            "spot"
        }
    };
    object.insert("type".into(), json!(kind));
    Ok(object.into())
}
