"""Records in containers: clatter beside npTDMS, pyuff, lvm_read, scipy and h5py, channel by channel.

    containers.py DIRECTORY COMMAND [FILE…]   COMMAND: clatter; FILE: .tdms, .uff, .lvm that are there already

    pip install numpy==2.4.6 npTDMS==1.13.0 pyuff==2.5.8 lvm_read==1.26 scipy==1.17.1 h5py==3.16.0

Files are written by these readers' own writers, or put together here and read by them; each channel is compared by its number of
samples, its first time, its step and its values. Every file is also cut short at many places and read by both. The answer is JSON:
files and channels that agree, and what does not.
"""

import io, json, logging, os, random, struct, subprocess, sys, tempfile, warnings

import h5py, lvm_read, nptdms, numpy as np, pyuff, scipy.io

warnings.filterwarnings("ignore")
logging.disable()
G = 9.80665
RANDOM = np.random.default_rng(7)


def shock(count, step, peak=50.0):
    t = np.arange(count) * step
    pulse = lambda start, width, height: np.where((t >= start) & (t <= start + width), height * np.sin(np.pi * (t - start) / width), 0.0)
    return pulse(0.2 * count * step, 0.1 * count * step, peak) + pulse(0.5 * count * step, 0.05 * count * step, -0.4 * peak) + RANDOM.normal(0, 0.01, count)


# TDMS ---------------------------------------------------------------------------------------------------------------------

def tdms_file(path, *segments):
    with nptdms.TdmsWriter(path) as writer:
        for segment in segments:
            writer.write_segment(segment)


def tdms_channel(group, name, values, step, start=0.0, unit="g", **more):
    more = {"wf_increment": step, "wf_start_offset": start, "unit_string": unit, "wf_samples": len(values)} | more
    return nptdms.ChannelObject(group, name, values, properties=more)


def tdms_files(folder):
    at = lambda name: os.path.join(folder, name)
    one = lambda name, *a, **k: tdms_channel("run", name, *a, **k)
    tdms_file(at("rates.tdms"), [one("ax", shock(300, 1e-4), 1e-4), one("ay", shock(150, 2e-4), 2e-4), one("az", shock(300, 1e-4), 1e-4, 0.5)])
    tdms_file(at("xunit.tdms"), [one("ax", shock(300, 1e-4), 0.1, wf_xunit_string="ms"), one("ay", shock(300, 1e-4), 100.0, 7.0, wf_xunit_string="us")])
    zero = np.datetime64("2024-02-03T04:05:06")
    tdms_file(at("starts.tdms"), [one("ax", shock(300, 1e-4), 1e-4, wf_start_time=zero), one("ay", shock(300, 1e-4), 1e-4, wf_start_time=zero + np.timedelta64(1500, "us"))])
    tdms_file(at("groups.tdms"), [tdms_channel("a", "acc", shock(100, 1e-4), 1e-4), tdms_channel("b", "acc", shock(200, 1e-3), 1e-3)])
    parts = [[one("ax", shock(100, 1e-4).astype("f4"), 1e-4), one("ay", (100 * shock(50, 2e-4)).astype("i2"), 2e-4)] for _ in range(4)]
    tdms_file(at("segments.tdms"), *parts)
    daqmx(at("daqmx.tdms"), 100)
    daqmx(at("daqmx_big.tdms"), 100, big=True)
    daqmx(at("daqmx_cards.tdms"), 60, cards=2)
    interleaved(at("interleaved.tdms"), 120)


def lead_in(meta, raw, contents, big=False):
    order = ">" if big else "<"
    return b"TDSm" + struct.pack("<I", contents | (1 << 6 if big else 0)) + struct.pack(order + "IQQ", 4713, len(meta) + len(raw), len(meta)) + meta + raw


def properties(order, pairs):
    text = lambda s: struct.pack(order + "I", len(s)) + s.encode()
    out = struct.pack(order + "I", len(pairs))
    for name, value in pairs.items():
        if isinstance(value, str):
            out += text(name) + struct.pack(order + "I", 0x20) + text(value)
        elif isinstance(value, int):
            out += text(name) + struct.pack(order + "II", 7, value)
        else:
            out += text(name) + struct.pack(order + "Id", 10, value)
    return out


def daqmx(path, count, big=False, cards=1):
    """Writes two 16-bit channels and a digital line on each card, each channel with a linear scale, in two chunks."""
    order = ">" if big else "<"
    text = lambda s: struct.pack(order + "I", len(s)) + s.encode()
    rows, chunks = count // 2, 2
    widths = [6] * cards
    meta, channels = b"", []
    for card in range(cards):
        for k in range(2):
            channels.append((f"/'card {card}'/'a{k}'", card, 2 * k, False))
        channels.append((f"/'card {card}'/'line'", card, 8 * 4 + 3, True))
    meta += struct.pack(order + "I", len(channels))
    for name, card, offset, digital in channels:
        meta += text(name) + struct.pack(order + "I", 0x126A if digital else 0x1269)
        meta += struct.pack(order + "IIQI", 0xFFFFFFFF if not digital else 5, 1, rows, 1)
        # The type is 16-bit signed, or one bit of a byte.
        meta += struct.pack(order + ("IIIBI" if digital else "IIIII"), 0 if digital else 3, card, offset, 0, 0)
        meta += struct.pack(order + "I", cards) + b"".join(struct.pack(order + "I", w) for w in widths)
        scales = {} if digital else {"NI_Number_Of_Scales": 2, "NI_Scale[1]_Scale_Type": "Linear", "NI_Scale[1]_Linear_Slope": 0.01, "NI_Scale[1]_Linear_Y_Intercept": 0.5, "NI_Scale[1]_Linear_Input_Source": 0, "NI_Scaling_Status": "unscaled"}
        meta += properties(order, scales | {"wf_increment": 1e-4 * (card + 1), "wf_start_offset": 0.0, "NI_UnitDescription": "V" if digital else "g"})
    raw = b""
    for _ in range(chunks):
        for card in range(cards):
            a = np.stack([(100 * shock(rows, 1e-4)).astype(order + "i2"), (50 * shock(rows, 1e-4)).astype(order + "i2")], axis=1)
            bits = RANDOM.integers(0, 256, (rows, 2)).astype("u1")
            raw += np.concatenate([a.view("u1"), bits], axis=1).tobytes()
    open(path, "wb").write(lead_in(meta, raw, 0b10001110, big))


def interleaved(path, count):
    text = lambda s: struct.pack("<I", len(s)) + s.encode()
    meta = struct.pack("<I", 2)
    for name, step in [("a", 1e-4), ("b", 1e-4)]:
        meta += text(f"/'g'/'{name}'") + struct.pack("<IIIQ", 20, 10, 1, count) + properties("<", {"wf_increment": step, "wf_start_offset": 0.25, "unit_string": "g"})
    raw = np.stack([shock(count, 1e-4), shock(count, 1e-4)], axis=1).tobytes()
    open(path, "wb").write(lead_in(meta, raw, 0b101110))


def read_tdms(data):
    file = nptdms.TdmsFile.read(io.BytesIO(data))
    channels = [c for g in file.groups() for c in g.channels() if len(c) > 0]
    starts = [c.properties["wf_start_time"] for c in channels if "wf_start_time" in c.properties]
    unit = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
    found = []
    for c in channels:
        p = c.properties
        if (p.get("unit_string") or p.get("NI_UnitDescription")) != "g":
            continue
        size = unit[p.get("wf_xunit_string") or "s"]
        later = (p["wf_start_time"] - min(starts)) / np.timedelta64(1, "s") if starts else 0.0
        found.append((len(c), p["wf_start_offset"] * size + later, p["wf_increment"] * size, np.asarray(c[:], float) * G))
    return found


# UFF ----------------------------------------------------------------------------------------------------------------------

def uff_block(values, step, start=0.0, **more):
    x = start + np.arange(len(values)) * step
    block = {
        "type": 58, "func_type": 1, "rsp_node": 1, "rsp_dir": 3, "ref_dir": 3, "ref_node": 1, "data": values, "x": x, "id1": "id1",
        "rsp_ent_name": "", "ref_ent_name": "", "abscissa_spacing": 1, "abscissa_spec_data_type": 17, "ordinate_spec_data_type": 12,
        "orddenom_spec_data_type": 0, "ordinate_axis_lab": "Acceleration", "ordinate_axis_units_lab": "m/s^2",
        "abscissa_axis_lab": "Time", "abscissa_axis_units_lab": "s",
    }
    return block | more


def uff_files(folder):
    at = lambda name: os.path.join(folder, name)
    sets = {
        "rates": [uff_block(shock(300, 1e-4), 1e-4), uff_block(shock(150, 2e-4), 2e-4, rsp_dir=1), uff_block(shock(300, 1e-4), 1e-4, 0.5, rsp_dir=2)],
        "none": [uff_block(shock(100, 1e-4), 1e-4, abscissa_axis_lab="NONE", abscissa_axis_units_lab="NONE")],
        "empty": [uff_block(shock(100, 1e-4), 1e-4, abscissa_axis_lab="", abscissa_axis_units_lab="", ordinate_axis_lab="", rsp_node=0)],
        "unlabeled": [uff_block(shock(100, 1e-4), 1e-4, ordinate_axis_lab="NONE", rsp_node=0, rsp_dir=0, ordinate_spec_data_type=0)],
        "uneven": [uff_block(shock(100, 1e-4), 1e-4, abscissa_spacing=0), uff_block(shock(60, 1e-3), 1e-3, abscissa_spacing=0, rsp_dir=1), uff_block(shock(50, 1e-3), 1e-3, 0.5, rsp_dir=2)],
        "uneven_none": [uff_block(shock(100, 1e-4), 1e-4, abscissa_spacing=0, abscissa_axis_lab="NONE", abscissa_axis_units_lab="NONE")],
        "binary": [uff_block(shock(300, 1e-4), 1e-4, binary=1), uff_block(shock(150, 2e-4), 2e-4, binary=1, rsp_dir=1)],
    }
    for name, blocks in sets.items():
        path = at(name + ".uff")
        if os.path.exists(path):
            os.remove(path)
        pyuff.UFF(path).write_sets(blocks, "add")


def read_uff(data):
    with tempfile.NamedTemporaryFile(suffix=".uff") as file:
        file.write(data)
        file.flush()
        sets = pyuff.UFF(file.name).read_sets()
    sets = sets if isinstance(sets, list) else [sets]
    found = []
    for s in sets:
        if s["type"] == 58 and s["ordinate_axis_units_lab"].strip() in ("m/s^2", "m/s2"):
            x = s["x"]
            found.append((len(x), x[0], (x[-1] - x[0]) / (len(x) - 1), np.asarray(s["data"], float)))
    return found


# LVM ----------------------------------------------------------------------------------------------------------------------

def lvm(path, channels, x_columns="No", point=".", separator="\t", segments=1, again=0.5, comment=False, x0=0.0):
    """Writes `channels`: name, unit, step and values of each."""
    number = lambda value, form: format(value, form).replace(".", point)
    line = lambda *cells: separator.join(map(str, cells)) + "\n"
    word = {"\t": "Tab", ",": "Comma"}[separator]
    out = line("LabVIEW Measurement", "") + "".join(line(*pair) for pair in [("Writer_Version", 2), ("Reader_Version", 2), ("Separator", word), ("Decimal_Separator", point), ("Multi_Headings", "Yes"), ("X_Columns", x_columns), ("Time_Pref", "Relative"), ("Operator", "x"), ("Date", "2024/01/02"), ("Time", "10:00:00"), ("***End_of_Header***", "")])
    wide = lambda values: [cell for value in values for cell in ([value, ""] if x_columns == "Multi" else [value])]
    for k in range(segments):
        start = x0 + k * again
        out += "\n"
        rows = max(len(values) for *_, values in channels)
        head = [("Channels", [len(channels)]), ("Samples", wide(len(v) for *_, v in channels)), ("Date", wide("2024/01/02" for _ in channels)), ("Time", wide(number(0.0, "09.6f").join(["10:00:", ""]) for _ in channels)), ("Y_Unit_Label", wide(unit for _, unit, *_ in channels)), ("X_Dimension", wide("Time" for _ in channels)), ("X0", wide(number(start, ".16E") for _ in channels)), ("Delta_X", wide(number(step, ".6E") for _, _, step, _ in channels))]
        width = len(head[1][1]) + 1
        out += "".join(line(name, *cells, *[""] * (width - len(cells))) for name, cells in head)
        out += line("***End_of_Header***", *[""] * width)
        names = [name for name, *_ in channels]
        out += line(*(["X_Value"] + [c for name in names for c in (name, "X_Value")][:-1] if x_columns == "Multi" else ["X_Value", *names]), "Comment")
        for i in range(rows):
            cells = []
            for j, (_, _, step, values) in enumerate(channels):
                if x_columns == "Multi" or j == 0:
                    cells.append(number(start + i * step, ".7f") if x_columns != "No" and i < len(values) else "")
                cells.append(number(values[i], ".6f") if i < len(values) else "")
            out += line(*cells, *(["note, once"] if comment and i == 3 and separator == "\t" else []))
    open(path, "w").write(out)


def lvm_files(folder):
    at = lambda name: os.path.join(folder, name + ".lvm")
    two = lambda n=300: [("Excitation (Trigger)", "g", 1e-4, shock(n, 1e-4)), ("Response", "m/s^2", 1e-4, shock(n, 1e-4))]
    lvm(at("point"), two())
    lvm(at("comma"), two(), point=",")
    lvm(at("separated"), two(), separator=",")
    lvm(at("one"), two(), "One")
    lvm(at("one_comma"), two(), "One", ",", comment=True)
    lvm(at("multi"), [("ax", "g", 1e-4, shock(300, 1e-4)), ("ay", "g", 2e-4, shock(150, 2e-4))], "Multi")
    lvm(at("rates"), [("ax", "g", 1e-4, shock(300, 1e-4)), ("ay", "g", 2e-4, shock(150, 2e-4))])
    lvm(at("step"), [("ax", "g", 3.90625e-5, shock(300, 3.90625e-5))], point=",")
    for n in (2, 3, 10):
        lvm(at(f"short_{n}"), two(n))
        lvm(at(f"short_multi_{n}"), two(n), "Multi", ",")
        lvm(at(f"short_one_{n}"), two(n), "One")
    lvm(at("segments"), two(), segments=3)
    lvm(at("segments_one"), two(), "One", segments=3)
    lvm(at("goes_on"), two(), "One", segments=2, again=0.03)


def read_lvm(data, record=0):
    file = lvm_read.read_str(data.decode("utf-8"))
    s, way = file[record], file["X_Columns"]
    found = []
    for k in range(s["Channels"]):
        pick = 2 * k if way == "Multi" else k
        units = s.get("Y_Unit_Label", [])
        unit = {"g": G}.get(units[pick], 1.0)
        # Without a column of times the first one is dropped.
        values = s["data"][:, 2 * k + 1 if way == "Multi" else k + (way != "No")]
        values = values[: int(s["Samples"][pick])]
        found.append((len(values), s["X0"][pick], s["Delta_X"][pick], values * unit))
    return found


# MAT and HDF5 -------------------------------------------------------------------------------------------------------------

def mat_files(folder):
    """Writes the files; the expected channels are those written, and scipy reads the files as a check."""
    files = {}
    fast, slow = shock(300, 1e-4), shock(150, 2e-4)
    pairs = [(300, 0.0, 1e-4, fast), (150, 0.0, 2e-4, slow)]
    t1, t2 = np.arange(300) * 1e-4, np.arange(150) * 2e-4
    for name, form in [("pairs", "5"), ("pairs4", "4")]:
        scipy.io.savemat(os.path.join(folder, name + ".mat"), {"a1": fast[:, None], "a2": slow[:, None], "t1": t1[:, None], "t2": t2[:, None]}, format=form)
        files[name + ".mat"] = pairs
    scipy.io.savemat(os.path.join(folder, "structs.mat"), {"run1": {"acc": fast, "fs": 1e4}, "run2": {"acc": slow, "fs": 5e3}})
    files["structs.mat"] = pairs
    scipy.io.savemat(os.path.join(folder, "rate4.mat"), {"acc": fast[:, None].astype("f4"), "fs": np.array([[1e4]])}, format="4")
    files["rate4.mat"] = [(300, 0.0, 1e-4, fast.astype("f4").astype(float))]
    assert np.array_equal(scipy.io.loadmat(os.path.join(folder, "pairs4.mat"))["a2"].ravel(), slow)
    return files


def hdf5_files(folder):
    fast, slow = shock(300, 1e-4), shock(150, 2e-4)
    pairs = [(300, 0.0, 1e-4, fast), (150, 0.0, 2e-4, slow)]
    files = {}
    def file(name, fill, expected, **k):
        with h5py.File(os.path.join(folder, name), "w", **k) as out:
            fill(out)
        files[name] = expected
    def attributes(out):
        for name, values, step in [("a_fast", fast, 1e-4), ("a_slow", slow, 2e-4)]:
            out[name] = values
            out[name].attrs["dt"] = step
    def groups(out):
        for name, values, step in [("fast", fast, 1e-4), ("slow", slow, 2e-4)]:
            group = out.create_group(name)
            group["acc"], group["time"] = values, np.arange(len(values)) * step
    def numbered(out):
        for k, (values, step) in enumerate([(fast, 1e-4), (slow, 2e-4)]):
            out[f"acc{k + 1}"], out[f"t{k + 1}"] = values, np.arange(len(values)) * step
    file("attributes.h5", attributes, pairs)
    file("groups.h5", groups, pairs)
    file("numbered.h5", numbered, pairs)
    file("numbered_new.h5", numbered, pairs, libver="latest")
    return files


# Comparison ---------------------------------------------------------------------------------------------------------------

def clatter(command, path, *options):
    """Returns the channels that clatter reads, or its message."""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.npy")
        run = subprocess.run([command, "record", path, "--format=json", "-o", out, *options], capture_output=True, text=True)
        if run.returncode != 0:
            return run.stderr.strip(), ""
        answer, table = json.loads(run.stdout), np.load(out)
    found = []
    for channel in answer["channels"]:
        values = table[[n for n in table.dtype.names if n in (f"{channel['name']} [m/s2]",)][0]]
        found.append((channel["samples"], channel["start_s"], channel["step_s"], values[: channel["samples"]]))
    return found, run.stderr


def differs(ours, theirs):
    if isinstance(ours, str):
        return ours.splitlines()[0]
    if len(ours) != len(theirs):
        return f"{len(ours)} channels, {len(theirs)}"
    for k, ((n, start, step, values), (n2, start2, step2, values2)) in enumerate(zip(ours, theirs)):
        if n != n2:
            return f"channel {k}: {n} samples, {n2}"
        if step is None or abs(step / step2 - 1) > 1e-6 or abs(start - start2) > 1e-6 * step2:
            return f"channel {k}: from {start} every {step}, from {start2} every {step2}"
        if not np.allclose(values, values2, rtol=1e-12, atol=1e-12):
            return f"channel {k}: values differ by {np.max(np.abs(values - values2))}"
    return None


def main(folder, command, *given):
    os.makedirs(folder, exist_ok=True)
    for make in (tdms_files, uff_files, lvm_files):
        make(folder)
    expected = mat_files(folder) | hdf5_files(folder)
    readers = {".tdms": read_tdms, ".uff": read_uff, ".lvm": read_lvm}
    answer = {"files": 0, "channels": 0, "cut": 0, "differ": []}
    def compare(path, theirs, *options, of=None):
        ours, _ = clatter(command, path, *options)
        answer["files"] += 1
        what = differs(ours, theirs)
        if what:
            answer["differ"].append(f"{of or os.path.basename(path)} {' '.join(options)}: {what}")
        else:
            answer["channels"] += len(theirs)
    for name, theirs in expected.items():
        compare(os.path.join(folder, name), theirs, "--units=s,m/s2")
    made = [os.path.join(folder, name) for name in sorted(os.listdir(folder))]
    for path in [*made, *given]:
        reader = readers.get(os.path.splitext(path)[1])
        if reader is None:
            continue
        data = open(path, "rb").read()
        if "segments" in os.path.basename(path) and path.endswith(".lvm"):
            for n in range(3):
                compare(path, read_lvm(data, n), f"--record={n + 1}")
            continue
        if os.path.basename(path) == "goes_on.lvm":
            one, two = read_lvm(data, 0), read_lvm(data, 1)
            compare(path, [(2 * a[0], a[1], a[2], np.concatenate([a[3], b[3]])) for a, b in zip(one, two)])
            continue
        compare(path, reader(data))
    # TDMS files are cut short.
    chance = random.Random(3)
    for path in [path for path in made if path.endswith(".tdms")]:
        data = open(path, "rb").read()
        for _ in range(12):
            part = data[: chance.randrange(len(data) // 2, len(data))]
            cut = os.path.join(folder, "cut.tdms")
            open(cut, "wb").write(part)
            try:
                theirs = read_tdms(part)
            except Exception:
                theirs = None
            if theirs is None or not theirs or min(channel[0] for channel in theirs) < 2:
                continue
            ours, told = clatter(command, cut)
            answer["cut"] += 1
            what = differs(ours, theirs)
            if not what and len(part) < len(data) and "ends within" not in told:
                what = "nothing is told of the end"
            if what:
                answer["differ"].append(f"{os.path.basename(path)} cut to {len(part)} of {len(data)}: {what}")
            os.remove(cut)
    print(json.dumps(answer, indent=1))


if __name__ == "__main__":
    main(*sys.argv[1:])
