from __future__ import annotations

import pytest

from deltaviz.scene import page


def test_the_policy_lets_only_the_packaged_scripts_run() -> None:
    policy = page.load_page().policy
    # These are viser 1.1.1's; computed from the package, so another version has others.
    assert policy == (
        "default-src 'none'; "
        "script-src 'sha256-5iRcjB7VnwnYpbUpHa15FmjNIRu22hIQnvWuocHMxJw=' "
        "'sha256-o/BTEGoB4UnTxqb+3RxwUFQZkWXpqUxouHkbDNrAkqE=' 'wasm-unsafe-eval'; "
        "style-src 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self' data: blob:; "
        "worker-src blob:; font-src data:; frame-ancestors 'self'; base-uri 'none'; "
        "form-action 'none'"
    )


def test_the_page_carries_our_style_once() -> None:
    loaded = page.load_page()
    assert loaded.light.count(page.STYLE) == loaded.dark.count(page.STYLE) == 1
    assert "#141414" in loaded.dark.replace(page.STYLE, "")


@pytest.mark.parametrize(
    "html",
    [
        "<head></head>",
        "<script>a</script><script>b</script>",
        "<script data-p='!!!!!' data-ss='1' data-cs='1'>a</script>",
        "<script data-p='!!!!!' data-ss='x' data-cs='1'>a</script>",
    ],
)
def test_a_page_of_another_form_is_refused(html: str) -> None:
    with pytest.raises(page.PageFormatError):
        page.scripts_of(html)
