"""Every sentence about a link fits the page's message box and names a way out."""

from __future__ import annotations

import pytest

from deltaviz.link.catalogue import catalogue

MESSAGE_BOX = 200  # characters that it shows without being scrolled
WAYS_OUT = ("connect", "Connect", "Choose", "restart")


@pytest.mark.parametrize(("case", "sentence"), catalogue(), ids=[case for case, _ in catalogue()])
def test_a_sentence_fits_and_leads_out(case: str, sentence: str) -> None:
    assert 40 < len(sentence) <= MESSAGE_BOX
    assert sentence.endswith(".")
    assert any(way in sentence for way in WAYS_OUT)


def test_no_two_cases_are_told_alike() -> None:
    sentences = [sentence for _, sentence in catalogue()]
    assert len(set(sentences)) == len(sentences)
