"""Makes the files of this folder, each by the tool that defines or knows its kind.

    pip install numpy==2.4.6 scipy==1.17.1 h5py==3.16.0 hdf5storage==0.2.2 npTDMS==1.13.0 pyuff==2.5.8 pyarrow==26.0.1
    python make.py [npy wav …]

All hold the same numbers, which every kind of float and 16-bit integers hold exactly:
t[i] = i/1024, a[i] = (37 i mod 101 - 50)/4, b[i] = (53 i mod 97 - 48)*2, c[i] = 4 a[i], for i = 0 .. 39.
What a tool cannot write is put together here, and read by the tool as a check.
"""

import io
import os
import struct
import sys
import wave

import h5py
import hdf5storage
import nptdms
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pyuff
import scipy.io
import scipy.io.wavfile

os.chdir(os.path.dirname(os.path.abspath(__file__)))
N = 40
i = np.arange(N)
t = i / 1024
a = ((37 * i) % 101 - 50) / 4
b = ((53 * i) % 97 - 48) * 2.0
c = (4 * a).astype("<i2")
EPOCH_NS = 1_700_000_000_000_000_000
stamps_us = (EPOCH_NS // 1000 + 1000 * i).astype("<M8[us]")
big = 2**60 + i


def npy():
    np.save("c_order.npy", np.column_stack([t, a]))
    np.save("fortran_f4_big.npy", np.asfortranarray(np.column_stack([t, a]).astype(">f4")))
    np.save("rows.npy", np.vstack([t, a]))
    np.save("one_i2_big.npy", c.astype(">i2"))
    np.save("big_u8.npy", big.astype("<u8"))
    fields = [("t", "<f8"), ("tag", "S3"), ("acc", ">f4", (2,)), ("n", "<i2"), ("when", "<M8[us]")]
    table = np.zeros(N, fields)
    table["t"], table["tag"], table["n"], table["when"] = t, b"abc", c, stamps_us
    table["acc"][:, 0], table["acc"][:, 1] = a, b
    np.save("fields.npy", table)
    np.save("complex.npy", a + 1j * b)
    np.save("objects.npy", np.array([None, 1]), allow_pickle=True)


def wav():
    scipy.io.wavfile.write("u8.wav", 10000, (c.astype(int) + 128).astype("u1"))
    scipy.io.wavfile.write("i16_two.wav", 10000, np.column_stack([c * 8, b.astype("i2")]))
    scipy.io.wavfile.write("i32.wav", 10000, (c.astype("i4") << 16))
    scipy.io.wavfile.write("f32.wav", 10000, a.astype("f4"))
    scipy.io.wavfile.write("f64.wav", 10000, a)
    with wave.open("i24.wav", "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(3)
        file.setframerate(10000)
        file.writeframes(b"".join(struct.pack("<i", int(x) << 8)[:3] for x in c))
    data = c.astype(">i2").tobytes()
    rifx = b"RIFX" + struct.pack(">I", 36 + len(data)) + b"WAVEfmt " + struct.pack(">IHHIIHH", 16, 1, 1, 10000, 20000, 2, 16)
    write("rifx.wav", rifx + b"data" + struct.pack(">I", len(data)) + data)
    assert np.array_equal(scipy.io.wavfile.read("rifx.wav")[1], c)
    data = a.astype("<f4").tobytes()
    guid = struct.pack("<H", 3) + bytes.fromhex("000000001000800000aa00389b71")
    form = struct.pack("<HHIIHHHHI", 0xFFFE, 1, 10000, 40000, 4, 32, 22, 32, 4) + guid
    # An odd chunk before the data, a length of the data that was never entered.
    body = b"fmt " + struct.pack("<I", len(form)) + form + b"LIST" + struct.pack("<I", 3) + b"abc\0"
    write("extensible.wav", b"RIFF" + struct.pack("<I", 0xFFFFFFFF) + b"WAVE" + body + b"data" + b"\xff\xff\xff\xff" + data)
    form = struct.pack(">HHIIHHHHI", 0xFFFE, 1, 10000, 40000, 4, 32, 22, 32, 4) + struct.pack(">I", 3) + bytes.fromhex("00000010800000aa00389b71")
    body = b"fmt " + struct.pack(">I", len(form)) + form + b"data" + struct.pack(">I", len(data))
    write("extensible_big.wav", b"RIFX" + struct.pack(">I", 4 + len(body) + len(data)) + b"WAVE" + body + a.astype(">f4").tobytes())
    assert np.array_equal(scipy.io.wavfile.read("extensible_big.wav")[1], a)
    ds64 = struct.pack("<QQQI", 4 + 36 + 24 + 8 + len(data), len(data), N, 0)
    form = struct.pack("<HHIIHH", 3, 1, 10000, 40000, 4, 32)
    body = b"ds64" + struct.pack("<I", len(ds64)) + ds64 + b"fmt " + struct.pack("<I", len(form)) + form
    write("rf64.wav", b"RF64" + b"\xff" * 4 + b"WAVE" + body + b"data" + b"\xff" * 4 + data)
    assert np.array_equal(scipy.io.wavfile.read("rf64.wav")[1], a.astype("f4"))


def write(name, data):
    with open(name, "wb") as file:
        file.write(data)


def mat():
    variables = {
        "t": t, "a": a[:, None], "m": np.column_stack([c, b.astype("i2")]), "s": a.astype("f4"),
        "note": "drop 3", "fs": 1024.0, "cells": np.array([1, "x"], dtype=object),
        "run": {"acc": b, "name": "x", "inner": {"n": c}}, "empty": np.zeros((0, 3)), "big": big, "cube": np.zeros((2, 2, 2)),
        "z": a + 1j * b,
    }
    for name, compressed in [("plain.mat", False), ("packed.mat", True)]:
        scipy.io.savemat(name, variables, do_compression=compressed)
        data = open(name, "rb").read()
        write(name, b"MATLAB 5.0 MAT-file, made by scipy".ljust(116) + data[116:])
    scipy.io.savemat("complex.mat", {"z": a + 1j * b})
    data = open("complex.mat", "rb").read()
    write("complex.mat", b"MATLAB 5.0 MAT-file, made by scipy".ljust(116) + data[116:])
    scipy.io.savemat("level4.mat", {"t": t}, format="4")
    # Big-endian: a header, then one matrix of 16-bit integers that stand for doubles, as MATLAB packs them.
    def element(kind, data):
        return struct.pack(">II", kind, len(data)) + data + b"\0" * (-len(data) % 8)
    inner = element(6, struct.pack(">II", 6, 0)) + element(5, struct.pack(">ii", N, 1)) + struct.pack(">HH", 1, 1) + b"a\0\0\0"
    inner += element(3, c.astype(">i2").tobytes())
    write("big_endian.mat", b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI" + element(14, inner))
    assert np.array_equal(scipy.io.loadmat("big_endian.mat")["a"].ravel(), c)


def hdf5():
    with h5py.File("plain.h5", "w") as file:
        file["t"] = t
        file["acc"] = a
        file["acc"].attrs["units"] = "g"
        file["label"] = "drop 3"
        group = file.create_group("run 2")
        group.attrs["sample_rate"] = 1024.0
        group["m"] = np.column_stack([a, b]).astype("f4")
        group["own"] = b
        group["own"].attrs["dt"] = 0.25
        group["own"].attrs["unit"] = np.bytes_("m/s2")
        deep = group.create_group("deep")
        deep["x"] = c
    with h5py.File("packed.h5", "w", libver=("v110", "v110")) as file:
        file.create_dataset("t", data=t, chunks=(16,), compression="gzip", shuffle=True, fletcher32=True)
        file.create_dataset("m", data=np.vstack([a, b]).astype(">f4"), chunks=(1, 16), compression="gzip")
        file.create_dataset("growing", data=c, chunks=(7,), maxshape=(None,))
        file.create_dataset("lzf", data=b, chunks=(16,), compression="lzf")
        packed = file.create_dataset("scaled", data=c)
        packed.attrs["scale_factor"], packed.attrs["add_offset"] = 0.25, 1.0
        table = np.zeros(N, [("t", "<f8"), ("tag", "S3"), ("a", ">f4")])
        table["t"], table["a"] = t, a
        file["table"] = table
        file["fs"] = 1024.0
        file.create_dataset("cube", data=np.zeros((2, 2, 2)))
    variables = {"t": t[:, None], "m": np.column_stack([a, b]), "note": "drop 3", "fs": 1024.0}
    hdf5storage.savemat("v73.mat", variables, format="7.3")
    data = open("v73.mat", "rb").read()
    write("v73.mat", b"MATLAB 7.3 MAT-file, made by hdf5storage".ljust(116) + data[116:])


def tdms():
    with nptdms.TdmsWriter("segments.tdms") as writer:
        root, group = nptdms.RootObject({"title": "drop 3"}), nptdms.GroupObject("run 1")
        rate = {"wf_increment": 1 / 1024, "wf_start_offset": -0.25, "unit_string": "g"}
        for part in (slice(0, 15), slice(15, 30), slice(30, N)):
            writer.write_segment([
                root, group,
                nptdms.ChannelObject("run 1", "ax", a[part], rate),
                nptdms.ChannelObject("run 1", "it's", c[part]),
                nptdms.ChannelObject("run 1", "when", stamps_us[part]),
                nptdms.ChannelObject("run 1", "words", ["x", "yy"]),
                nptdms.ChannelObject("run 2", "ax", b[part].astype("f4")),
            ])
        writer.write_segment([nptdms.ChannelObject("run 2", "big", big)])
    scale = {
        "NI_Number_Of_Scales": 2, "NI_Scaling_Status": "unscaled",
        "NI_Scale[0]_Scale_Type": "Linear", "NI_Scale[0]_Linear_Slope": 0.25, "NI_Scale[0]_Linear_Y_Intercept": 1.0,
        "NI_Scale[0]_Linear_Input_Source": np.uint32(0xFFFFFFFF),
        "NI_Scale[1]_Scale_Type": "Polynomial", "NI_Scale[1]_Polynomial_Coefficients_Size": 3,
        "NI_Scale[1]_Polynomial_Coefficients[0]": 2.0, "NI_Scale[1]_Polynomial_Coefficients[1]": 0.0,
        "NI_Scale[1]_Polynomial_Coefficients[2]": 0.5, "NI_Scale[1]_Polynomial_Input_Source": np.uint32(0),
    }
    with nptdms.TdmsWriter("scaled.tdms") as writer:
        writer.write_segment([nptdms.ChannelObject("g", "a", c, scale)])
    scaled = nptdms.TdmsFile.read("scaled.tdms")["g"]["a"][:]
    assert np.array_equal(scaled, 2 + 0.5 * (0.25 * c + 1) ** 2)

    def text(order, word):
        return struct.pack(order + "I", len(word)) + word.encode()

    def listed(order, path, kind, count):
        return text(order, path) + struct.pack(order + "IIIQI", 20, kind, 1, count, 0)

    # Interleaved; two chunks in the first segment; the second goes on without a list, and was not finished.
    for name, order, bit in [("interleaved.tdms", "<", 0), ("interleaved_big.tdms", ">", 64)]:
        meta = struct.pack(order + "I", 2) + listed(order, "/'g'/'a'", 10, 10) + listed(order, "/'g'/'c'", 2, 10)
        rows = b"".join(struct.pack(order + "dh", x, y) for x, y in zip(a, c))
        half = 20 * 10
        lead = b"TDSm" + struct.pack("<I", 2 | 4 | 8 | 32 | bit) + struct.pack(order + "IQQ", 4713, len(meta) + half, len(meta))
        more = b"TDSm" + struct.pack("<I", 8 | 32 | bit) + struct.pack(order + "IQQ", 4713, 2**64 - 1, 0)
        write(name, lead + meta + rows[:half] + more + rows[half:])
        file = nptdms.TdmsFile.read(name)
        assert np.array_equal(file["g"]["a"][:], a) and np.array_equal(file["g"]["c"][:], c)


def uff():
    def block(label, values, even, double, binary, unit="m/s2", place=12, direction=3):
        return {
            "type": 58, "binary": binary, "id1": "NONE", "id2": "NONE", "id3": "01-Jan-24 00:00:00", "id4": "NONE", "id5": "NONE",
            "func_type": 1, "func_id": 0, "ver_num": 0, "load_case_id": 0, "rsp_ent_name": "NONE", "rsp_node": place,
            "rsp_dir": direction, "ref_ent_name": "NONE", "ref_node": 0, "ref_dir": 0,
            "ord_data_type": 4 if double else 2, "num_pts": N, "abscissa_spacing": int(even), "abscissa_min": 0.0,
            "abscissa_inc": 1 / 1024, "z_axis_value": 0.0, "abscissa_spec_data_type": 17, "abscissa_axis_lab": "Time",
            "abscissa_axis_units_lab": "s", "ordinate_spec_data_type": 12, "ordinate_axis_lab": label,
            "ordinate_axis_units_lab": unit, "orddenom_spec_data_type": 0, "z_axis_axis_lab": "NONE",
            "z_axis_axis_units_lab": "NONE", "orddenom_axis_lab": "NONE", "orddenom_axis_units_lab": "NONE",
            "x": t if even else t + (i % 2) / 65536, "data": values,
        }

    def save(name, *blocks):
        if os.path.exists(name):
            os.remove(name)
        for one in blocks:
            pyuff.UFF(name).write_sets(one, "add", force_double=False)

    save("even.uff", block("Acceleration", a, True, False, 0), block("NONE", b, True, True, 0, "g", 13, -1))
    save("uneven.uff", block("Acceleration", a, False, False, 0), block("Force", b, False, True, 0, "N"))
    save("binary.uff", block("Acceleration", a, True, True, 1), block("Force", b, True, True, 1, "N"))
    complex_block = block("FRF", a + 1j * b, True, True, 0)
    complex_block["ord_data_type"] = 6
    save("complex.uff", complex_block)
    for name, order, bit in [("binary_big.uff", ">", 2), ("binary_single.uff", "<", 1)]:
        head = open("uneven.uff", "rb").read().split(b"\n")[:13]
        kind = 4 if order == ">" else 2
        pairs = b"".join(struct.pack(order + ("fd" if kind == 4 else "ff"), x, y) for x, y in zip(t, a))
        head[1] = b"%6db%6d%6d%12d%12d%6d%6d%12d%12d" % (58, bit, 2, 11, len(pairs), 0, 0, 0, 0)
        head[8] = b"%10d" % kind + head[8][10:]
        write(name, b"\n".join(head) + b"\n" + pairs + b"\n    -1\n")


def columnar():
    valid = i % 5 != 3
    kinds = {
        "t": pa.array(t), "a": pa.array(a.astype("f4")), "gaps": pa.array(np.where(valid, b, 0), mask=~valid), "n": pa.array(c),
        "u": pa.array((c.astype(int) + 50).astype("u4")), "text": pa.array([f"row {k}" for k in i]),
        "kind": pa.array(["x", "y"] * (N // 2)).dictionary_encode(), "list": pa.array([[k, k] for k in i]),
        "pair": pa.array([{"x": k, "y": str(k)} for k in i]), "ms": pa.array(stamps_us.astype("M8[ms]")),
        "ns": pa.array(stamps_us.astype("M8[ns]")), "big": pa.array(big), "huge": pa.array((2**63 + i.astype("u8") * 4096)),
        "truth": pa.array(valid), "same": pa.array(np.full(N, 0.5)),
    }
    unit = {"a": {"unit": "g"}, "gaps": {"units": "m/s2"}}
    schema = pa.schema([pa.field(name, kind.type, metadata=unit.get(name)) for name, kind in kinds.items()])
    table = pa.Table.from_arrays(list(kinds.values()), schema=schema)
    options = dict(row_group_size=16, store_schema=True)
    for name, extra in {
        "snappy": dict(compression="snappy"), "gzip_v2": dict(compression="gzip", data_page_version="2.0"),
        "zstd": dict(compression="zstd", use_dictionary=False), "lz4": dict(compression="lz4", version="1.0"),
        "plain": dict(compression="none", column_encoding={"t": "BYTE_STREAM_SPLIT", "n": "DELTA_BINARY_PACKED", "big": "DELTA_BINARY_PACKED"}, use_dictionary=False),
    }.items():
        pq.write_table(table, f"{name}.parquet", **options, **extra)
    pq.write_table(table.select(["t", "ns"]), "int96.parquet", use_deprecated_int96_timestamps=True, **options)
    pq.write_table(table.select(["t"]), "brotli.parquet", compression="brotli")
    views = table.append_column("view", pa.array([f"a rather long text {k}" for k in i], pa.string_view()))
    views = views.set_column(0, "view0", views["view"]).append_column("t", pa.array(t))
    for name, codec in [("plain", None), ("lz4", "lz4"), ("zstd", "zstd")]:
        options = pa.ipc.IpcWriteOptions(compression=codec)
        with pa.ipc.new_file(f"{name}.arrow", table.schema, options=options) as writer:
            writer.write_table(table, max_chunksize=16)
    with pa.OSFile("stream.arrows", "wb") as sink, pa.ipc.new_stream(sink, views.schema) as writer:
        writer.write_table(views, max_chunksize=25)


def bombs():
    zeros = np.zeros(1_000_000)
    scipy.io.savemat("bomb.mat", {"a": zeros}, do_compression=True)
    data = open("bomb.mat", "rb").read()
    write("bomb.mat", b"MATLAB 5.0 MAT-file, made by scipy".ljust(116) + data[116:])
    with h5py.File("bomb.h5", "w") as file:
        file.create_dataset("a", data=zeros, chunks=(1_000_000,), compression="gzip", compression_opts=9)
    table = pa.table({"a": zeros})
    pq.write_table(table, "bomb_zstd.parquet", compression="zstd", use_dictionary=False)
    with pa.ipc.new_file("bomb_zstd.arrow", table.schema, options=pa.ipc.IpcWriteOptions(compression="zstd")) as writer:
        writer.write_table(table)


def channels():
    """Channels that each have times of their own: a at 1024 Hz, half of b at 512 Hz."""
    half = b[: N // 2]
    def tdms_channel(name, values, increment, start=0.0, **more):
        return nptdms.ChannelObject("run", name, values, {"wf_increment": increment, "wf_start_offset": start, "unit_string": "g"} | more)
    began = np.datetime64("2024-01-02T03:04:05")
    with nptdms.TdmsWriter("rates.tdms") as writer:
        later = began + np.timedelta64(500, "ms")
        writer.write_segment([
            tdms_channel("a", a, 1 / 1024, wf_start_time=began), tdms_channel("b", half, 1000 / 512, 250.0, wf_xunit_string="ms", wf_start_time=began),
            tdms_channel("later", a, 1 / 1024, wf_start_time=later), tdms_channel("spectrum", a, 0.5, wf_xunit_string="Hz"),
        ])
    # Raw data of DAQmx: rows of a, c as 16 bits and a byte of lines, in two chunks; a scale on each.
    for name, order, bit in [("daqmx.tdms", "<", 0), ("daqmx_big.tdms", ">", 64)]:
        text = lambda word: struct.pack(order + "I", len(word)) + word.encode()
        number = lambda name, value: text(name) + struct.pack(order + "Id", 10, value)
        whole = lambda name, value: text(name) + struct.pack(order + "II", 7, value)
        word = lambda name, value: text(name) + struct.pack(order + "I", 0x20) + text(value)
        def scaler(kind, code, at):
            out = struct.pack(order + "I", kind) + struct.pack(order + "IIQI", 1 if kind == 0x126A else 2**32 - 1, 1, N // 2, 1)
            out += struct.pack(order + ("IIIBI" if kind == 0x126A else "IIIII"), code, 0, at, 0, 0)
            return out + struct.pack(order + "II", 1, 5)
        meta = struct.pack(order + "I", 3)
        for channel, at, slope in [("a", 0, 0.25), ("c", 2, 1.0)]:
            meta += text(f"/'card'/'{channel}'") + scaler(0x1269, 3, at) + struct.pack(order + "I", 7) + whole("NI_Number_Of_Scales", 2)
            meta += word("NI_Scale[1]_Scale_Type", "Linear") + number("NI_Scale[1]_Linear_Slope", slope) + number("NI_Scale[1]_Linear_Y_Intercept", 0.0)
            meta += whole("NI_Scale[1]_Linear_Input_Source", 0) + number("wf_increment", 1 / 1024) + word("NI_UnitDescription", "g")
        meta += text("/'card'/'line'") + scaler(0x126A, 1, 8 * 4 + 3) + struct.pack(order + "I", 0)
        rows = b"".join(struct.pack(order + "hhB", x, x, (k % 2) << 3 | 0x55 & ~8) for k, x in enumerate(c))
        write(name, b"TDSm" + struct.pack("<I", 2 | 4 | 8 | 128 | bit) + struct.pack(order + "IQQ", 4713, len(meta) + len(rows), len(meta)) + meta + rows)
        card = nptdms.TdmsFile.read(name)["card"]
        assert np.array_equal(card["a"][:], a) and np.array_equal(card["c"][:], c) and np.array_equal(card["line"][:], i % 2)
    # MATLAB 4 on a big-endian machine.
    def level4(name, values, code):
        values = np.asfortranarray(np.atleast_2d(values.T).T)
        head = struct.pack(">5I", 1000 + 10 * code, *values.shape, 0, len(name) + 1) + name.encode() + b"\0"
        return head + values.astype({0: ">f8", 3: ">i2"}[code]).tobytes(order="F")
    write("level4_big.mat", level4("a", a, 0) + level4("m", np.column_stack([c, b]), 3) + level4("fs", np.array([1024.0]), 0))
    assert np.array_equal(scipy.io.loadmat("level4_big.mat")["m"], np.column_stack([c, b]))
    scipy.io.savemat("structs.mat", {"one": {"acc": a, "fs": 1024.0}, "two": {"acc": half, "dt": 1 / 512}})
    data = open("structs.mat", "rb").read()
    write("structs.mat", b"MATLAB 5.0 MAT-file, made by scipy".ljust(116) + data[116:])
    with h5py.File("numbered.h5", "w") as file:
        file["acc1"], file["acc2"], file["t1"], file["t2"] = a, half, t, t[::2]
        group = file.create_group("run time")
        group["acc"], group["time"] = half, t[::2]


makes = (npy, wav, mat, hdf5, tdms, uff, columnar, bombs, channels)
for make in makes:
    # Some alone by their names.
    if not sys.argv[1:] or make.__name__ in sys.argv[1:]:
        make()
