"""Makes one file of each container with a member for each type of number that it knows, and members.json.

    pip install numpy==2.4.6 scipy==1.17.1 h5py==3.16.0 npTDMS==1.13.0 pyarrow==26.0.1
    python make_members.py

The name of a member begins with what it holds: a and c are those of make.py, u is c + 50, t counts ticks of the last word of its
name, x is no column of numbers. members.json lists the members of each file as the library that defines its kind lists them.
"""

import json
import os
from decimal import Decimal

import h5py
import nptdms
import numpy as np
import pyarrow as pa
import pyarrow.feather
import pyarrow.parquet as pq
import scipy.io
import scipy.sparse

os.chdir(os.path.dirname(os.path.abspath(__file__)))
N = 40
i = np.arange(N)
a = ((37 * i) % 101 - 50) / 4
c = (4 * a).astype("<i2")
WHOLE = ["int8", "int16", "int32", "int64"]
members = {}


def whole():
    return {f"c_{kind}": c.astype(kind) for kind in WHOLE} | {f"u_u{kind}": (c + 50).astype(f"u{kind}") for kind in WHOLE}


def texts():
    return [f"{x:.2f}" for x in a]


def words():
    return [f"row {k}" for k in i]


def columnar():
    tick = lambda kind, small=False: pa.array(i.astype("i4" if small else "i8")).cast(kind)
    decimals = [Decimal(text) for text in texts()]
    kinds = {name: pa.array(values) for name, values in whole().items()} | {
        "a_half": pa.array(a.astype("f2")), "a_single": pa.array(a.astype("f4")), "a_double": pa.array(a),
        "a_decimal32": pa.array(decimals, pa.decimal32(7, 2)), "a_decimal64": pa.array(decimals, pa.decimal64(12, 2)),
        "a_decimal128": pa.array(decimals, pa.decimal128(20, 2)), "a_decimal256": pa.array(decimals, pa.decimal256(50, 2)),
        "a_text": pa.array(texts()), "a_large_text": pa.array(texts(), pa.large_string()),
        "a_dictionary": pa.array(a).dictionary_encode(), "a_categories": pa.array(texts()).dictionary_encode(),
        "a_structure": pa.array([{"x": x, "in": {"y": x}} for x in a]),
        "x_words": pa.array(words()), "x_categories": pa.array(["x", "y"] * (N // 2)).dictionary_encode(),
        "x_bytes": pa.array([b"\0\1"] * N), "x_fixed_bytes": pa.array([b"\0\1"] * N, pa.binary(2)),
        "x_list": pa.array([[x] for x in a]), "x_fixed_list": pa.array([[x, x] for x in a], pa.list_(pa.float64(), 2)),
        "x_truth": pa.array(a > 0), "x_nothing": pa.nulls(N), "x_map": pa.array([[("k", 1.0)]] * N, pa.map_(pa.string(), pa.float64())),
        "x_date32": tick(pa.date32(), True), "x_date64": pa.array(i * 86_400_000).cast(pa.date64()),
        "t_time s": tick(pa.time32("s"), True), "t_time ms": tick(pa.time32("ms"), True),
        "t_time us": tick(pa.time64("us")), "t_time ns": tick(pa.time64("ns")),
    }
    for unit in ["s", "ms", "us", "ns"]:
        kinds[f"t_stamp {unit}"], kinds[f"t_duration {unit}"] = tick(pa.timestamp(unit)), tick(pa.duration(unit))
    table = pa.table(kinds)
    pq.write_table(table, "members.parquet")
    pq.write_table(table, "members_v2.parquet", use_dictionary=False, data_page_version="2.0", compression="zstd")
    members["members.parquet"] = members["members_v2.parquet"] = table.schema.names
    table = table.append_column("a_short_view", pa.array(texts(), pa.string_view()))
    table = table.append_column("a_long_view", pa.array([text + 12 * "0" for text in texts()], pa.string_view()))
    table = table.append_column("x_byte_view", pa.array([b"x"] * N, pa.binary_view()))
    table = table.append_column("x_runs", pa.compute.run_end_encode(pa.array(a)))
    table = table.append_column("a_last", pa.array(a))
    for name, codec in [("members.arrow", None), ("members_lz4.arrow", "lz4")]:
        with pa.ipc.new_file(name, table.schema, options=pa.ipc.IpcWriteOptions(compression=codec)) as writer:
            writer.write_table(table, max_chunksize=16)
        members[name] = table.schema.names
    # What a heading says of the unit does not hold for a duration or a time of day.
    pq.write_table(pa.table({"time [s]": tick(pa.duration("ms")), "a [g]": a}), "duration.parquet")
    pq.write_table(pa.table({"time [ms]": tick(pa.time64("us")), "a [g]": a}), "clock.parquet")


def hdf5():
    with h5py.File("members.h5", "w") as file:
        for name, values in whole().items():
            file[name] = values
        file["a_half"], file["a_single"], file["a_double"], file["a_big_single"] = a.astype("f2"), a.astype("f4"), a, a.astype(">f4")
        file["a_long_double"] = a.astype("longdouble")
        file["a_text"], file["a_long_text"] = np.array(texts(), "S8"), texts()
        file["x_words"], file["x_wide_words"], file["x_fixed_words"] = words(), np.array(words(), "S100"), np.array(words(), "S9")
        file["x_complex"], file["x_complex64"], file["x_truth"] = a + 1j, (a + 1j).astype("c8"), a > 0
        file.create_dataset("x_enumeration", data=c % 2, dtype=h5py.enum_dtype({"A": 0, "B": 1}, "i1"))
        file["x_bytes"] = np.zeros(N, "V4")
        file.create_dataset("x_list", (N,), h5py.vlen_dtype("f8"))
        file.create_dataset("x_reference", (N,), h5py.ref_dtype)
        file["x_cube"], file["a_flat_cube"], file["x_empty"], file["x_nothing"] = np.zeros((4, 4, 4)), a.reshape(1, N, 1), [], h5py.Empty("f8")
        file["x_single"], file["x_single_text"] = 4.5, "drop 3"
        kinds = [("a_half", "f2"), ("a_text", "S8"), ("a_pair", "f8", (2,)), ("x_truth", "?"), ("x_complex", "c16"), ("x_words", "S100"), ("a_in", [("y", "f4")])]
        table = np.zeros(N, kinds)
        table["a_half"], table["a_text"], table["a_pair"], table["a_in"]["y"] = a, texts(), a[:, None], a
        file["table"] = table
        space = h5py.h5s.create_simple((N,))
        twelve_bits = h5py.h5t.STD_I16LE.copy()
        twelve_bits.set_precision(12)
        h5py.h5d.create(file.id, b"x_twelve_bits", twelve_bits, space)
        h5py.h5d.create(file.id, b"x_bits", h5py.h5t.STD_B8LE, space)
        names = [name for name in file if name != "table"]
        members["members.h5"] = names + [f"table.{name}" for name in table.dtype.names]
    with h5py.File("fill.h5", "w") as file:
        def put(name, values, **attributes):
            file[name] = values
            file[name].attrs.update(attributes)
        put("packed", np.where(i == 7, -32768, c), _FillValue=np.int16(-32768), scale_factor=0.5)
        put("single", np.where(i == 7, -99999.9, a).astype("f4"), missing_value=-99999.9)
        put("long", np.where(i == 7, -(2**63), c.astype("i8")), missing_value=np.array([1000, -(2**63)]))
    # MATLAB 7.3, by its attributes.
    with h5py.File("members73.mat", "w", userblock_size=512) as file:
        def put(name, values, kind, **attributes):
            file[name] = values
            file[name].attrs.update(MATLAB_class=np.bytes_(kind), **attributes)
        put("a_double", a[None, :], "double")
        put("a_single", a[None, :].astype("f4"), "single")
        put("c_int8", c[None, :].astype("i1"), "int8")
        put("x_truth", (a[None, :] > 0).astype("u1"), "logical", MATLAB_int_decode=1)
        put("x_text", np.frombuffer(b"drop 3", "u1").astype("u2")[:, None], "char", MATLAB_int_decode=2)
        put("x_empty", np.array([0, 0], "u8"), "double", MATLAB_empty=1)
        put("x_table", np.zeros((1, 6), "u4"), "table")
        put("x_complex", np.array([[(x, 1.0) for x in a]], [("real", "f8"), ("imag", "f8")]), "double")
        file.create_dataset("x_cell", (1, 3), h5py.ref_dtype).attrs["MATLAB_class"] = np.bytes_("cell")
        for name, values, kind in [("a_sparse", a, "double"), ("x_sparse_truth", a, "logical"), ("x_sparse_complex", a + 1j, "double")]:
            group = file.create_group(name)
            group.attrs.update(MATLAB_class=np.bytes_(kind), MATLAB_sparse=np.uint64(N))
            rows = np.flatnonzero(values)
            group["ir"], group["jc"] = rows.astype("u8"), np.array([0, len(rows)], "u8")
            kept = values[rows]
            group["data"] = kept if kept.dtype.kind == "f" else np.array([(x.real, x.imag) for x in kept], [("real", "f8"), ("imag", "f8")])
        members["members73.mat"] = list(file)
    data = open("members73.mat", "rb").read()
    write("members73.mat", b"MATLAB 7.3 MAT-file, made by h5py".ljust(124) + b"\x00\x02IM" + data[128:])


def write(name, data):
    with open(name, "wb") as file:
        file.write(data)


def mat():
    sparse = scipy.sparse.csc_matrix
    column = a[:, None]
    variables = {
        "a_double": a, "a_single": a.astype("f4"), "a_sparse": sparse(column), "a_three": sparse(np.column_stack([a, a, a])),
        "a_letters": np.array(texts()), "x_letters": np.array(["ab", "cd"]), "x_words": "drop 3", "x_complex": a + 1j,
        "x_sparse_complex": sparse(column + 1j), "x_single": 3.5, "x_empty": np.zeros((0, 3)),
    }
    write_level4 = {name: values for name, values in variables.items() if name != "x_letters"}
    scipy.io.savemat("members4.mat", write_level4, format="4")
    variables |= whole() | {
        "x_truth": a > 0, "x_sparse_truth": sparse(column > 0), "x_cell": np.array(list(a), dtype=object),
        "a_structure": {"x": a, "in": {"y": a, "s": sparse(column)}}, "x_structures": np.array([(1.0, 2.0)] * 3, [("p", "O"), ("q", "O")]),
        "x_cube": np.zeros((2, 2, 2)), "x_no_rows": sparse((0, 0)),
    }
    scipy.io.savemat("members.mat", variables, do_compression=True)
    data = open("members.mat", "rb").read()
    write("members.mat", b"MATLAB 5.0 MAT-file, made by scipy".ljust(116) + data[116:])
    for name in ["members.mat", "members4.mat"]:
        members[name] = [name for name, _, _ in scipy.io.whosmat(name)]


def npy():
    kinds = [
        ("a_half", "f2"), ("a_single", ">f4"), ("a_double", "f8"), ("a_text", "S8"), ("a_wide_text", "U8"), ("a_big_text", ">U8"),
        ("a_pair", "f4", (2,)), ("x_truth", "?"), ("x_complex64", "c8"), ("x_complex", "c16"), ("x_bytes", "V4"),
        ("x_long_double", "longdouble"), ("x_date", "M8[D]"), ("x_duration", "m8"), ("x_words", "U8"), ("a_in", [("y", "f2")]),
    ]
    kinds += [(name, values.dtype) for name, values in whole().items()]
    kinds += [(f"t_{kind} {unit}", f"{code}8[{unit}]") for kind, code in [("stamp", "M"), ("duration", "m")] for unit in ["s", "ms", "us", "ns"]]
    table = np.zeros(N, kinds)
    for name, values in whole().items():
        table[name] = values
    for name in ["a_half", "a_single", "a_double"]:
        table[name] = a
    for name in ["a_text", "a_wide_text", "a_big_text"]:
        table[name] = texts()
    table["a_pair"], table["a_in"]["y"], table["x_words"] = a[:, None], a, words()
    for name in table.dtype.names:
        if name.startswith("t_"):
            table[name] = i.astype(table.dtype[name])
    np.save("members.npy", table)
    members["members.npy"] = list(table.dtype.names)
    np.save("text.npy", np.array([[text, text] for text in texts()]))
    np.save("truths.npy", a > 0)


def tdms():
    channels = whole() | {
        "a_single": a.astype("f4"), "a_double": a, "a_text": texts(), "x_words": words(), "x_truth": a > 0,
        "x_complex64": (a + 1j).astype("c8"), "x_complex": a + 1j, "t_stamp us": i.astype("M8[us]"),
    }
    with nptdms.TdmsWriter("members.tdms") as writer:
        for part in (slice(0, 15), slice(15, N)):
            writer.write_segment([nptdms.ChannelObject("run", name, values[part]) for name, values in channels.items()] + [nptdms.ChannelObject("run", "x_nothing", [])])
    members["members.tdms"] = [channel.name for channel in nptdms.TdmsFile.read("members.tdms")["run"].channels()]


for make in (columnar, hdf5, mat, npy, tdms):
    make()
write("members.json", (json.dumps(members, indent=1) + "\n").encode())
