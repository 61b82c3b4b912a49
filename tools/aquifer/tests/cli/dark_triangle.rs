//! A scene of one triangle.

/// The text of a `.gltf`: a triangle `x` metres from the world's origin, a camera before it, and no light at all.
pub fn dark_triangle(x: u32) -> String {
    const CORNERS: &str = "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA";
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"mesh": 0, "translation": [{x}, 0, 0]}}, {{"camera": 0, "translation": [{x}, 0, 3]}}],
"cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.8, "znear": 0.1}}}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}}],
"bufferViews": [{{"buffer": 0, "byteLength": 36}}],
"buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,{CORNERS}"}}]}}"#
    )
}
