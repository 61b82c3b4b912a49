//! The report in a real browser. Skipped where there is no Chromium, unless AQUIFER_REQUIRE_BROWSER=1.

#[path = "page/browser.rs"]
mod browser;
#[path = "page/fixture.rs"]
mod fixture;

use aquifer_lab::page;
use browser::Browser;
use fixture::{BRIGHT, DARK, FACTOR, SIZE};
use serde_json::{Value, json};

const STAGE: &str = "document.querySelector('#viewer-scene-0 .stage')";

/// Colour on the first viewer's canvas, at shares of its width and height.
fn color(browser: &mut Browser, [x, y]: [f64; 2]) -> [u8; 3] {
    let value = browser.evaluate(&format!(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {{
            const canvas = {STAGE}.querySelector('canvas');
            const copy = Object.assign(document.createElement('canvas'), {{width: 1, height: 1}}).getContext('2d', {{willReadFrequently: true}});
            copy.drawImage(canvas, -Math.floor({x} * canvas.width), -Math.floor({y} * canvas.height));
            const data = copy.getImageData(0, 0, 1, 1).data;
            done([data[0], data[1], data[2]]);
        }})))"
    ));
    [0, 1, 2].map(|c| value[c].as_u64().expect("a byte") as u8)
}

/// A point of the first viewer's stage in the window, after the stage has been laid out anew.
fn place(browser: &mut Browser, [x, y]: [f64; 2]) -> [f64; 2] {
    let point = browser.evaluate(&format!(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {{
            const b = {STAGE}.getBoundingClientRect();
            done([b.left + {x} * b.width, b.top + {y} * b.height]);
        }})))"
    ));
    [0, 1].map(|c| point[c].as_f64().expect("a number"))
}

fn choose(browser: &mut Browser, control: &str, value: &str) {
    browser.evaluate(&format!(
        "(() => {{ const c = document.querySelector('#viewer-scene-0 [data-is={control}]'); c.value = '{value}'; c.dispatchEvent(new Event('change', {{bubbles: true}})); c.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
    ));
}

/// Grey of a linear value under the sRGB curve.
fn grey(linear: f32) -> [u8; 3] {
    [(255.0 * (1.055 * linear.powf(1.0 / 2.4) - 0.055)).round() as u8; 3]
}

#[track_caller]
fn close(a: [u8; 3], b: [u8; 3]) {
    assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1), "{a:?} {b:?}");
}

#[test]
fn the_report_works_in_a_browser() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    page::write(&fixture::report(folder.path()), folder.path()).expect("a page");
    browser.pretend([1280, 900], false);
    browser.open(&folder.path().join("report.html"));
    browser.screenshot("top");
    reads_in_words(&mut browser);
    browser.evaluate(&format!("{STAGE}.scrollIntoView({{block: 'center', behavior: 'instant'}})"));
    browser.wait_for(&format!("Number({STAGE}.dataset.painted) > 0"));
    choose(&mut browser, "curve", "linear");
    choose(&mut browser, "amount", "0");
    keys_flip(&mut browser);
    layers_show_errors(&mut browser);
    the_slider_slides(&mut browser);
    images_move_in_step(&mut browser);
    pixels_are_read(&mut browser);
    follows_theme_and_width(&mut browser);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

fn reads_in_words(browser: &mut Browser) {
    let text = browser.evaluate("document.body.innerText");
    let text = text.as_str().expect("text");
    for words in [
        "second has 4.00 times lower mean square error at equal time than first (geometric mean of 2 scenes; lower on each).",
        "a warning",
        "+50.0 ± 0.100 %",
        "cornell, MSE 0.00200: second reaches it in 37.5 ms, 4.00 times sooner than first",
        "+25.0 ± 0.100 %",
        "no setting turns it off",
    ] {
        assert!(text.contains(words), "`{words}` is not in\n{text}");
    }
    // Text of graphs stays text.
    assert_eq!(browser.evaluate("document.querySelector('details pre').textContent"), json!("title = \"</script>\""));
    // Three plots of errors and two of correlations a scene, each drawn.
    assert_eq!(browser.evaluate("document.querySelectorAll('.chart > svg, .chart > figure').length"), json!(10));
    let nameless = "[...document.querySelectorAll('button, input, select, [role=slider]')].filter((e) => !e.innerText && !e.labels?.length && !e.ariaLabel).length";
    assert_eq!(browser.evaluate(nameless), json!(0));
}

fn keys_flip(browser: &mut Browser) {
    for (key, dark, bright) in [("0", DARK, BRIGHT), ("2", FACTOR * DARK, FACTOR * BRIGHT), ("1", DARK, BRIGHT)] {
        browser.press(key);
        assert_eq!(browser.evaluate(&format!("{STAGE}.dataset.shown")), json!(key));
        close(color(browser, [0.25, 0.5]), grey(dark));
        close(color(browser, [0.75, 0.5]), grey(bright));
    }
    // Four quarters of a stop.
    (0..4).for_each(|_| browser.press("]"));
    close(color(browser, [0.25, 0.5]), grey(2.0 * DARK));
    (0..4).for_each(|_| browser.press("["));
}

fn layers_show_errors(browser: &mut Browser) {
    browser.press("d");
    let [r, g, b] = color(browser, [0.75, 0.5]);
    assert!(r > 200 && g > 200 && b > 200, "no difference is pale: {r} {g} {b}");
    browser.press("2");
    let [r, _, b] = color(browser, [0.75, 0.5]);
    assert!(r > b + 50, "too bright is red: {r} {b}");
    browser.press("p");
    let shown = color(browser, [0.75, 0.5]);
    browser.press("1");
    let none = color(browser, [0.75, 0.5]);
    assert!(none.iter().all(|&c| c < 20) && shown.map(u32::from).iter().sum::<u32>() > 80, "{none:?} {shown:?}");
    browser.press("i");
}

fn the_slider_slides(browser: &mut Browser) {
    browser.press("s");
    choose(browser, "left", "0");
    choose(browser, "right", "2");
    close(color(browser, [0.3, 0.5]), grey(DARK));
    let (from, to) = (place(browser, [0.5, 0.5]), place(browser, [0.2, 0.5]));
    browser.drag(from, to);
    let divider = "document.querySelector('#viewer-scene-0 .divider')";
    assert_eq!(browser.evaluate(&format!("{divider}.getAttribute('aria-valuenow')")), json!("20"));
    close(color(browser, [0.3, 0.5]), grey(FACTOR * DARK));
    close(color(browser, [0.1, 0.5]), grey(DARK));
    browser.evaluate(&format!("{divider}.focus()"));
    browser.press("End");
    assert_eq!(browser.evaluate(&format!("{divider}.getAttribute('aria-valuenow')")), json!("100"));
    close(color(browser, [0.3, 0.5]), grey(DARK));
    browser.screenshot("slider");
}

fn images_move_in_step(browser: &mut Browser) {
    browser.press("g");
    // Three images in columns: the second cell shows the same as the first, the third is brighter.
    let left = [1.0 / 12.0, 5.0 / 12.0, 9.0 / 12.0];
    let shown = left.map(|x| color(browser, [x, 0.5]));
    close(shown[0], grey(DARK));
    close(shown[1], grey(DARK));
    close(shown[2], grey(FACTOR * DARK));
    browser.press("+");
    browser.press("+");
    browser.press("+");
    let (from, to) = (place(browser, [0.3, 0.5]), place(browser, [0.05, 0.5]));
    browser.drag(from, to);
    let moved = left.map(|x| color(browser, [x, 0.5]));
    close(moved[0], grey(BRIGHT));
    close(moved[1], grey(BRIGHT));
    close(moved[2], grey(FACTOR * BRIGHT));
    browser.screenshot("grid");
    browser.press("r");
    browser.press("f");
}

fn pixels_are_read(browser: &mut Browser) {
    let at = place(browser, [0.77, 0.52]);
    browser.hover(at);
    let table = "document.querySelector('#viewer-scene-0 [data-is=readout]')";
    let caption = format!("Pixel {}, {}", SIZE[0] * 3 / 4, SIZE[1] / 2);
    browser.wait_for(&format!("{table}.querySelector('caption')?.textContent === '{caption}'"));
    browser.wait_for(&format!("{table}.querySelectorAll('tbody tr').length === 3"));
    let cells = browser.evaluate(&format!("[...{table}.querySelectorAll('tbody td')].map((td) => td.textContent)"));
    let second: Vec<&str> = cells.as_array().expect("cells")[8..].iter().filter_map(Value::as_str).collect();
    // The relative difference has the epsilon of relMSE.
    let off = format!("+{:.1} %", 100.0 * (FACTOR - 1.0) * BRIGHT / (BRIGHT + 0.01));
    assert_eq!(second, ["0.75", "0.75", "0.75", &off]);
}

fn follows_theme_and_width(browser: &mut Browser) {
    let background = "getComputedStyle(document.body).backgroundColor";
    let light = browser.evaluate(background);
    browser.pretend([360, 740], true);
    browser.evaluate("new Promise((done) => setTimeout(done, 100))");
    assert_ne!(browser.evaluate(background), light);
    // Nothing sticks out of a narrow window; wide tables scroll by themselves.
    assert_eq!(browser.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth"), json!(0));
    browser.screenshot("narrow_dark");
    browser.evaluate("document.getElementById('theme').click()");
    assert_eq!(browser.evaluate(background), light);
}
