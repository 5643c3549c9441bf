"""One message with given lengths of its arrays and texts: a compiled format."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

from deltaviz.link.wire.conversions import CODES, Conversion
from deltaviz.link.wire.description import FieldDescription


class Span(NamedTuple):
    """Where a field's numbers stand; `stop` is None for a single one."""

    start: int
    stop: int | None
    conversion: Conversion | None


class Layout:
    """`counts` has the value of each field that counts something, in their order."""

    def __init__(
        self,
        fields: Sequence[FieldDescription],
        conversions: Sequence[Conversion | None],
        counts: Sequence[int],
    ) -> None:
        codes = ["<"]
        self._numbers: list[Any] = []  # with the counts in their places
        self._spans: list[Span] = []
        joints, remaining = 0, iter(counts)
        for field, conversion in zip(fields, conversions, strict=True):
            parsed, code = field.parsed, CODES.get(field.parsed.base, "B")
            if parsed.base in ("joints", "text"):
                count = next(remaining)
                self._numbers.append(count)
                codes.append("B")
                if parsed.base == "joints":
                    joints = count
                    continue
                code = f"{count}s"
            at, size = len(self._numbers), 1
            if parsed.count is not None:
                size = joints if parsed.count == "joints" else parsed.count
                code = code * size
            codes.append(code)
            self._numbers += [0] * size
            self._spans.append(
                Span(at, None if parsed.count is None else at + size, conversion),
            )
        self._struct = struct.Struct("".join(codes))

    def decode(self, payload: bytes) -> list[Any]:
        numbers = self._struct.unpack(payload)
        values: list[Any] = []
        for start, stop, conversion in self._spans:
            if stop is None:
                number = numbers[start]
                values.append(number if conversion is None else conversion.decode(number))
            elif conversion is None:
                values.append(numbers[start:stop])
            else:
                values.append(tuple(map(conversion.decode, numbers[start:stop])))
        return values

    def encode(self, values: Sequence[Any]) -> bytes:
        numbers = self._numbers.copy()
        for (start, stop, conversion), value in zip(self._spans, values, strict=True):
            if stop is None:
                numbers[start] = value if conversion is None else conversion.encode(value)
            elif len(value) != stop - start:
                raise ValueError(f"{value} does not have {stop - start} entries")
            else:
                numbers[start:stop] = value if conversion is None else map(conversion.encode, value)
        return self._struct.pack(*numbers)
