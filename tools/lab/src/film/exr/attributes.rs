//! Facts as EXR attributes: the one place that knows their names.
//!
//! `samplesPerPixel` and `renderTimeSeconds` are spelt as pbrt spells them; the rest is Aquifer's own. Lists (the seeds and frames of
//! merged films) are texts separated by spaces. Texts are UTF-8.

use super::super::{Facts, FilmError, GraphText, Run, Runs};
use exr::prelude::{AttributeValue, Text};
use std::{collections::HashMap, path::Path};

const SAMPLES: &str = "samplesPerPixel";
const SECONDS: &str = "renderTimeSeconds";
const GRAPH: &str = "aquifer:graph";
const GRAPH_HASH: &str = "aquifer:graph_hash";
const SCENE: &str = "aquifer:scene";
const ENVIRONMENT: &str = "aquifer:environment";
const CAMERA: &str = "aquifer:camera";
const ANIMATION_TIME: &str = "aquifer:animation_time";
const TRANSPORT: &str = "aquifer:transport";
const SEED: &str = "aquifer:seed";
const FIRST_FRAME: &str = "aquifer:first_frame";
const FRAMES: &str = "aquifer:frames";
const ADAPTER: &str = "aquifer:adapter";
const VERSION: &str = "aquifer:version";

type Attributes = HashMap<Text, AttributeValue>;

pub(super) fn from_facts(facts: &Facts, path: &Path) -> Result<Attributes, FilmError> {
    let samples =
        i32::try_from(facts.samples_per_pixel).map_err(|_| wrong(path, SAMPLES, format!("cannot hold {}", facts.samples_per_pixel)))?;
    let list = |number: fn(&Run) -> u64| facts.runs.iter().map(|run| number(run).to_string()).collect::<Vec<_>>().join(" ");
    let mut attributes: Attributes = [
        (SAMPLES, AttributeValue::I32(samples)),
        (SECONDS, AttributeValue::F64(facts.render_seconds)),
        (ANIMATION_TIME, AttributeValue::F32(facts.animation_time)),
    ]
    .map(|(name, value)| (Text::from(name), value))
    .into();
    let texts = [
        (GRAPH, facts.graph.text.clone()),
        (GRAPH_HASH, facts.graph.hash.clone()),
        (SCENE, facts.scene.clone()),
        (CAMERA, facts.camera.clone()),
        (TRANSPORT, facts.transport.clone()),
        (SEED, list(|run| run.seed)),
        (FIRST_FRAME, list(|run| run.first_frame)),
        (FRAMES, list(|run| run.frames)),
        (ADAPTER, facts.adapter.clone()),
        (VERSION, facts.version.clone()),
    ];
    for (name, text) in texts.into_iter().chain(facts.environment.clone().map(|text| (ENVIRONMENT, text))) {
        attributes.insert(Text::from(name), AttributeValue::Text(Text::from_slice_unchecked(text.as_bytes())));
    }
    Ok(attributes)
}

/// `None` where there are none of Aquifer's own: the file is another program's.
pub(super) fn to_facts(attributes: &Attributes, path: &Path) -> Result<Option<Facts>, FilmError> {
    let reader = Reader { attributes, path };
    if reader.find(VERSION).is_none() {
        return Ok(None);
    }
    Ok(Some(Facts {
        samples_per_pixel: reader.samples()?,
        render_seconds: reader.number(SECONDS)?,
        graph: GraphText { text: reader.text(GRAPH)?, hash: reader.text(GRAPH_HASH)? },
        scene: reader.text(SCENE)?,
        environment: reader.find(ENVIRONMENT).map(|_| reader.text(ENVIRONMENT)).transpose()?,
        camera: reader.text(CAMERA)?,
        animation_time: reader.number(ANIMATION_TIME)? as f32,
        transport: reader.text(TRANSPORT)?,
        runs: reader.runs()?,
        adapter: reader.text(ADAPTER)?,
        version: reader.text(VERSION)?,
    }))
}

struct Reader<'a> {
    attributes: &'a Attributes,
    path: &'a Path,
}

impl Reader<'_> {
    fn find(&self, name: &str) -> Option<&AttributeValue> {
        self.attributes.get(&Text::from(name))
    }

    fn samples(&self) -> Result<u32, FilmError> {
        match self.find(SAMPLES) {
            Some(&AttributeValue::I32(value)) => u32::try_from(value).map_err(|_| wrong(self.path, SAMPLES, "is negative".into())),
            _ => Err(wrong(self.path, SAMPLES, "is no integer".into())),
        }
    }

    fn number(&self, name: &'static str) -> Result<f64, FilmError> {
        match self.find(name) {
            Some(&AttributeValue::F64(value)) => Ok(value),
            Some(&AttributeValue::F32(value)) => Ok(f64::from(value)),
            _ => Err(wrong(self.path, name, "is no number".into())),
        }
    }

    fn text(&self, name: &'static str) -> Result<String, FilmError> {
        match self.find(name) {
            Some(AttributeValue::Text(text)) => {
                String::from_utf8(text.as_slice().to_vec()).map_err(|_| wrong(self.path, name, "is not UTF-8".into()))
            }
            _ => Err(wrong(self.path, name, "is no text".into())),
        }
    }

    fn list(&self, name: &'static str) -> Result<Vec<u64>, FilmError> {
        let text = self.text(name)?;
        let numbers: Result<_, _> = text.split(' ').map(str::parse).collect();
        numbers.map_err(|_| wrong(self.path, name, format!("is no list of integers: `{text}`")))
    }

    fn runs(&self) -> Result<Runs, FilmError> {
        let (seeds, first, frames) = (self.list(SEED)?, self.list(FIRST_FRAME)?, self.list(FRAMES)?);
        if seeds.len() != first.len() || seeds.len() != frames.len() {
            return Err(wrong(self.path, FRAMES, format!("is not as long a list as `{SEED}` and `{FIRST_FRAME}`")));
        }
        let runs = seeds.into_iter().zip(first).zip(frames).map(|((seed, first_frame), frames)| Run { seed, first_frame, frames });
        Runs::new(runs.collect()).map_err(|overlap| wrong(self.path, FRAMES, format!("repeats frames: {overlap}")))
    }
}

fn wrong(path: &Path, name: &'static str, why: String) -> FilmError {
    FilmError::Attribute { path: path.to_owned(), name, why }
}
