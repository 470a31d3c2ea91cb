"""Studies that are larger than one machine: shards of a plan, each a Parquet file, and the answer of all of them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence

from . import _clatter
from ._answer import Answer, Rows, ending, flat, told
from ._products import survivals

Path = str | os.PathLike[str]


def study(plan: Path, output: Path, *, shard: tuple[int, int] = (1, 1), force: bool = False) -> Answer:
    """Draw a shard of a study into a Parquet file.

    Its rows depend on the plan and their numbers alone: shards are drawn by any process, on any machine and in any order. The
    file is there once it is whole; a shard that is there already is left as it is.

    Parameters
    ----------
    plan : path
        Plan of the study, as ``clatter study`` has it; its product is looked for beside it.
    output : path
        File of the rows, in SI, ending in ``.parquet``.
    shard : (int, int)
        Which, from 1, of how many.
    force : bool
        Draw it although a file is there.

    Returns
    -------
    Answer
        ``rows``, the first and the one after the last, ``of`` how many the plan has; ``skipped`` where the shard was there.

    Examples
    --------
    >>> import clatter, pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = folder.joinpath("handheld.toml").write_text(clatter.Product.example().text)
    >>> _ = folder.joinpath("plan.toml").write_text("product = 'handheld.toml'\\nsamples = 100\\n")
    >>> parts = [folder / f"part{i}.parquet" for i in (1, 2)]
    >>> [clatter.study(folder / "plan.toml", part, shard=(i, 2)).rows for i, part in enumerate(parts, 1)]
    [[0, 50], [50, 100]]
    >>> clatter.merge(parts).members[0].survival.probability
    1.0
    """
    text, odd = _clatter.study(locals() | {"output": ending(output, ".parquet")})
    if odd:
        warnings.warn(odd, stacklevel=2)
    return told((text, None))


def merge(parts: Sequence[Path], *, confidence: float = 0.95, target: float | None = None) -> Answer:
    """What the shards of a study say together.

    Parameters
    ----------
    parts : list of path
        Files of :func:`study` or of the command: all shards of one plan, each once, in any order.
    confidence : float
        Of the intervals, in (0, 1).
    target : float, optional
        Survival of all parts that is to be sure, in (0, 1).

    Returns
    -------
    Answer
        ``members``, one for each product of the grid: what :func:`scatter` answers, of a search the verdicts on its ``limits``; as
        ``clatter study merge`` has it.

    Examples
    --------
    >>> import clatter, pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = folder.joinpath("handheld.toml").write_text(clatter.Product.example().text)
    >>> plan = "product = 'handheld.toml'\\nsearch = true\\n[grid]\\nproduct.restitution = [0.2, 0.3]\\n"
    >>> _ = folder.joinpath("plan.toml").write_text(plan)
    >>> _ = clatter.study(folder / "plan.toml", folder / "all.parquet")
    >>> [(member.values, member.verdict) for member in clatter.merge([folder / "all.parquet"]).members]
    [(['0.2'], 'safe'), (['0.3'], 'safe')]
    """
    return told(_clatter.merge(locals()), _rows)


def _rows(answer: Answer) -> Rows:
    """A row for each part of each product, of a search for each limit."""
    return [
        {"member": i, **dict(zip(answer.grid, member.values)), **told_of}
        for i, member in enumerate(answer.members)
        for told_of in (survivals(member) if "components" in member else [flat(limit, "") for limit in member.limits])
    ]
