"""GET /docs: the API's description as one plain page, made here from its OpenAPI document.

The usual viewers load scripts from other hosts; this needs none, and works without internet.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from html import escape
from typing import Any

STYLE = """
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 52rem; margin: 2rem auto; padding: 0 1rem; }
h2 { margin: 2rem 0 0.25rem; font-size: 1.1rem; }
h2 b { display: inline-block; min-width: 3.5rem; }
code, pre, h2 { font-family: ui-monospace, monospace; }
pre { overflow-x: auto; padding: 0.75rem; border: 1px solid #868e96; border-radius: 4px; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 0.2rem 1rem 0.2rem 0; }
th { font-weight: normal; white-space: nowrap; }
"""

Schema = dict[str, Any]


def page(api: Schema, *, base: str) -> str:
    """The document `api` (OpenAPI 3) as HTML. Its style is at /docs/style.css.

    `base` is this server's address, for the examples.
    """
    calls = "\n".join(
        _call(api, base + path, method, call)
        for path, methods in api["paths"].items()
        for method, call in methods.items()
    )
    title = escape(f"{api['info']['title']} {api['info']['version']}: HTTP API")
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<link rel="stylesheet" href="/docs/style.css">
<link rel="icon" href="/favicon.svg">
</head>
<body>
<h1>{title}</h1>
<p>{escape(api["info"]["description"])}</p>
<p>For programs: <a href="/openapi.json">openapi.json</a>. The page: <a href="/">deltaviz</a>.</p>
{calls}
</body>
</html>
"""


def _call(api: Schema, url: str, method: str, call: Schema) -> str:
    path = "/" + url.split("/", 3)[3]
    parts = [f"<h2><b>{method.upper()}</b> {escape(path)}</h2>"]
    parts.append(f"<p>{escape(call.get('description', ''))}</p>")
    if body := _body(api, call):
        parts.append(_table(_fields(api, body)))
        parts.append(f"<pre>{escape(_curl(url, body))}</pre>")
    answers = ((code, answer["description"]) for code, answer in call["responses"].items())
    parts.append(_table(answers))
    return "\n".join(parts)


def _body(api: Schema, call: Schema) -> Schema | None:
    content = call.get("requestBody", {}).get("content", {})
    schema = _resolved(api, content.get("application/json", {}).get("schema", {}))
    return schema if "properties" in schema else None


def _fields(api: Schema, body: Schema) -> Iterator[tuple[str, str]]:
    for name, schema in body["properties"].items():
        needed = "" if name in body.get("required", ()) else ", optional"
        what = schema.get("description", "")
        yield name, f"{_kind(api, schema)}{needed}{'; ' + what if what else ''}"


def _kind(api: Schema, schema: Schema) -> str:
    schema = _resolved(api, schema)
    if choices := schema.get("anyOf", schema.get("oneOf")):
        kinds = [_kind(api, choice) for choice in choices if choice.get("type") != "null"]
        return " or ".join(kinds)
    if "enum" in schema:
        return " or ".join(json.dumps(value) for value in schema["enum"])
    if schema.get("type") == "array":
        return f"{_count(schema)} of ({_kind(api, schema['items'])})"
    return schema.get("type", "value") + _bounds(schema)


def _count(schema: Schema) -> str:
    low, high = schema.get("minItems"), schema.get("maxItems")
    return "list" if high is None else f"{low}" if low == high else f"{low} to {high}"


def _bounds(schema: Schema) -> str:
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum", schema.get("exclusiveMaximum"))
    return "" if low is None or high is None else f" from {low:g} to {high:g}"


def _curl(url: str, body: Schema) -> str:
    values = {
        name: schema["examples"][0]
        for name, schema in body["properties"].items()
        if schema.get("examples") and schema["examples"][0] is not None
    }
    for name in body.get("required", ()):
        values.setdefault(name, (body["properties"][name].get("enum") or [""])[0])
    data = json.dumps(values)
    return f"curl -H 'Content-Type: application/json' -d '{data}' {url}"


def _resolved(api: Schema, schema: Schema) -> Schema:
    if not isinstance(reference := schema.get("$ref"), str):
        return schema
    found: Schema = api
    for part in reference.removeprefix("#/").split("/"):
        found = found[part]
    return found


def _table(rows: Iterator[tuple[str, str]]) -> str:
    cells = "".join(
        f"<tr><th><code>{escape(name)}</code></th><td>{escape(what)}</td></tr>"
        for name, what in rows
    )
    return f"<table>{cells}</table>"
