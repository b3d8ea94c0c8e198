//! The page: its program, and the data that it shows.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

/// The page's program and style, built from `report/` and compressed (gzip). In a browser the page around this program has them.
#[cfg(target_family = "wasm")]
const BUNDLE: &[u8] = &[];
/// The page's program and style, built from `report/` and compressed (gzip).
#[cfg(not(target_family = "wasm"))]
const BUNDLE: &[u8] = include_bytes!("../../../report/bundle/report.js.gz");

/// A whole page of a title, data, and words for readers without scripts.
pub fn page(title: &str, words: &str, data: &Value) -> String {
    let (title, words) = (escaped(title), escaped(words));
    // In a script element, only this would end it.
    let data = data.to_string().replace('<', "\\u003c");
    let bundle = STANDARD.encode(BUNDLE);
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{title}</title>
<style>body{{font-family:system-ui,sans-serif;margin:0}}#loading{{padding:2rem}}</style>
</head>
<body>
<div id="report"><p id="loading">Unpacking the report &hellip;</p></div>
<noscript><h1>{title}</h1><p>Plots and playback need JavaScript. The summary:</p><pre>{words}</pre></noscript>
<script type="application/json" id="data">{data}</script>
<script type="text/plain" id="bundle">{bundle}</script>
<script>
(async () => {{
  try {{
    const bytes = Uint8Array.from(atob(document.getElementById('bundle').textContent), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    const script = document.createElement('script');
    script.textContent = await new Response(stream).text();
    document.body.append(script);
  }} catch (why) {{
    document.getElementById('loading').textContent = 'This browser cannot unpack the report: ' + why;
  }}
}})();
</script>
</body>
</html>
"#
    )
}

/// Text as it may stand in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
