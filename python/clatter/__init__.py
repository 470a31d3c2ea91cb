"""What a tilted drop does to the parts inside a flat product.

The answers of the command ``clatter``, to the last digit, as Python objects:

- one question: :func:`impacts`, :func:`zone`, :func:`atlas`, :func:`map`, :func:`simulate`, :func:`respond`;
- arrays of questions: :func:`bars`, :func:`trains`, :func:`zones`, :func:`shocks`, :func:`plates`, :func:`boxes`,
  :func:`spectra`;
- measured accelerations: :class:`Record`, :func:`spectrum`, :class:`Pulse`;
- products: :class:`Product`, :func:`assess`, :func:`scatter`, :func:`design`, :func:`explain`, :func:`tradeoff`, :func:`fit`;
- studies larger than one machine: :func:`study`, :func:`merge`.

Where names have no unit, velocities are in v0, the drop speed, upward positive; times in h0/v0, where h0 is the height of end
b as end a touches; positions in half-lengths from the middle, -1 at end a. Names with a unit are in it.

Arrays are of numpy, pandas, polars, pyarrow, lists or whatever makes an array: of numbers that float64 holds, without masked
elements, and without units of other packages. No answer has memory of what was given. A call takes ten million elements.

What is refused is a ValueError in the words of the command, what is odd a warning. Work and the reading of files run without the
lock of the interpreter, and Ctrl-C ends them. Objects may be compared, copied, pickled and sent to other processes; pictures are
drawn in the process that was asked.
"""

from ._answer import Answer, Figure
from ._bars import atlas, bars, impacts, map, plates, shocks, trains, zone, zones
from ._clatter import __version__
from ._drops import boxes, respond, simulate
from ._products import Product, assess, design, explain, fit, scatter, schema, tradeoff
from ._records import Pulse, Record, spectra, spectrum
from ._studies import merge, study

__all__ = [
    "Answer",
    "Figure",
    "Product",
    "Pulse",
    "Record",
    "__version__",
    "assess",
    "atlas",
    "bars",
    "boxes",
    "design",
    "explain",
    "fit",
    "impacts",
    "map",
    "merge",
    "plates",
    "respond",
    "scatter",
    "schema",
    "shocks",
    "simulate",
    "spectra",
    "spectrum",
    "study",
    "tradeoff",
    "trains",
    "zone",
    "zones",
]
