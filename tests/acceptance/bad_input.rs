//! Bad input: one message that names the flag, the value and what is allowed, exit 2, and nothing on stdout.

use clatter_cli::Exit;

use crate::clatter;

/// Each row: arguments, and what the message has to say.
#[rustfmt::skip]
const REFUSED: &[(&[&str], &[&str])] = &[
    // Inertia: exactly one way, within its range.
    (&["impacts", "--q=1.0000000000000002", "--e=0"], &["--q", "1.0000000000000002", "(-1, 1]"]),
    (&["impacts", "--q=-1", "--e=0"], &["--q", "-1", "(-1, 1]"]),
    (&["impacts", "--q=nan", "--e=0"], &["--q", "nan", "(-1, 1]"]),
    (&["impacts", "--q=-inf", "--e=0"], &["--q", "-inf", "(-1, 1]"]),
    (&["impacts", "--q=1e308", "--e=0"], &["--q", "1e308", "(-1, 1]"]),
    (&["impacts", "--q=0,5", "--e=0"], &["--q", "'0,5' is not a number such as 0.5"]),
    (&["impacts", "--q=", "--e=0"], &["--q", "'' is not a number"]),
    (&["impacts", "--q= 0.5", "--e=0"], &["--q", "' 0.5' is not a number"]),
    (&["impacts", "--e=0"], &["--q <Q>|--gyration-ratio <K>"]),
    (&["impacts", "--q=0.5", "--gyration-ratio=1", "--e=0"], &["--q", "--gyration-ratio", "cannot be used with"]),
    (&["impacts", "--q=0.5", "--q=0.5", "--e=0"], &["--q", "multiple times"]),
    (&["impacts", "--gyration-ratio=-0.1", "--e=0"], &["--gyration-ratio", "-0.1"]),
    (&["impacts", "--gyration-ratio=1e308", "--e=0"], &["--gyration-ratio", "1e308"]),
    (&["impacts", "--gyration-ratio=NaN", "--e=0"], &["--gyration-ratio", "NaN"]),
    // Restitution.
    (&["impacts", "--q=0.5"], &["--e <E>"]),
    (&["impacts", "--q=0.5", "--e=1.0000000000000002"], &["--e", "1.0000000000000002", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=-5e-324"], &["--e", "-5e-324", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=inf"], &["--e", "inf", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=130 %"], &["--e", "1.3", "[0, 1]"]),
    (&["impacts", "--q=0.5", "--e=some"], &["--e", "'some' is not a share"]),
    // Start: end a has to come down, at a speed that leaves room for the results.
    (&["impacts", "--q=0.5", "--e=0", "--velocity=1"], &["--velocity", "'1'", "VA,VB"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=,"], &["--velocity", "','", "'' is not a number"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,-1,-1"], &["--velocity", "-1,-1,-1"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-4m/s,-4m/s"], &["--velocity", "'-4m/s' is not a number", "in v0, without a unit"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=0,-1"], &["--velocity", "0,-1", "v_a in [-1e150, -1e-150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-5e-324,-1"], &["--velocity", "-5e-324", "-1e-150"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,nan"], &["--velocity", "-1,nan", "v_b"]),
    (&["impacts", "--q=0.5", "--e=0", "--velocity=-1,1e308"], &["--velocity", "1e308", "1e150"]),
    (&["impacts", "--q=0.5", "--e=0", "--height-gap=-1"], &["--height-gap", "-1", "[1e-150, 1e150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--height-gap=inf"], &["--height-gap", "inf", "[1e-150, 1e150]"]),
    (&["impacts", "--q=0.5", "--e=0", "--at=2"], &["--at", "2", "[-1, 1]"]),
    (&["impacts", "--q=0.5", "--e=0", "--at=0", "--at=nan"], &["--at", "nan", "[-1, 1]"]),
    (&["impacts", "--q=0.5", "--e=0", "--limit=-1"], &["--limit", "-1", "whole number"]),
    (&["impacts", "--q=0.5", "--e=0", "--limit=1e3"], &["--limit", "1e3", "whole number"]),
    (&["impacts", "--q=0.5", "--e=0", "--format=xml"], &["--format", "xml", "table, json, csv"]),
    // Zones.
    (&["zone", "--q=0.5", "--e=0"], &["--threshold <X>"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=0"], &["--threshold", "0", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=-1"], &["--threshold", "-1", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=nan"], &["--threshold", "nan", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=inf"], &["--threshold", "inf", "[1e-150, 1e150]"]),
    (&["zone", "--q=0.5", "--e=0", "--threshold=1", "--first=c"], &["--first", "c", "a, b"]),
    // Maps: nothing is computed, let alone written, before everything is right.
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2"], &["--output <FILE>"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", "x.txt"], &["x.txt", ".csv, .json, .npy or .svg"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", "csv"], &["csv", ".csv, .json, .npy or .svg"]),
    (&["map", "duration", "--q=0:1:2", "--e=0:1:2", "-o", ""], &["--output", ".csv, .json, .npy or .svg"]),
    (&["map", "speed", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["speed", "peak-end", "net-center"]),
    (&["map", "zone", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["--threshold <X>"]),
    (&["map", "impacts", "--threshold=1", "--q=0:1:2", "--e=0:1:2", "-o", "x.csv"], &["--threshold", "zone alone"]),
    (&["map", "impacts", "--q=0:1", "--e=0:1:2", "-o", "x.csv"], &["--q", "0:1", "LO:HI:N"]),
    (&["map", "impacts", "--q=0.5", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.5", "LO:HI:N"]),
    (&["map", "impacts", "--q=0:1:2", "--e=::", "-o", "x.csv"], &["--e", "'::'", "''"]),
    (&["map", "impacts", "--q=0:1:2", "--e=0:1:1e3", "-o", "x.csv"], &["--e", "'1e3' is not a number of values"]),
    (&["map", "impacts", "--q=0:1:-2", "--e=0:1:2", "-o", "x.csv"], &["--q", "'-2' is not a number of values"]),
    (&["map", "impacts", "--q=1:0:2", "--e=0:1:2", "-o", "x.csv"], &["--q", "1.0:0.0:2"]),
    (&["map", "impacts", "--q=0:1:0", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.0:1.0:0"]),
    (&["map", "impacts", "--q=0:1:1", "--e=0:1:2", "-o", "x.csv"], &["--q", "0.0:1.0:1"]),
    (&["map", "impacts", "--q=-1:1:2", "--e=0:1:2", "-o", "x.csv"], &["--q", "-1.0:1.0:2"]),
    (&["map", "impacts", "--q=0:1:2", "--e=0:2:2", "-o", "x.csv"], &["--e", "0.0:2.0:2"]),
    (&["map", "impacts", "--q=0:1:2", "--e=nan:1:2", "-o", "x.csv"], &["--e", "NaN:1.0:2"]),
    // 8·10¹⁸ bytes, and more than a usize counts.
    (&["map", "impacts", "--q=0:1:1000000000", "--e=0:1:1000000000", "-o", "x.csv"], &["1000000000000000000 points", "memory"]),
    (&["map", "impacts", "--q=0:1:18446744073709551615", "--e=0:1:18446744073709551615", "-o", "x.csv"], &["memory"]),
    // Components.
    (&["respond", "--q=0.5", "--e=0", "--omega=1"], &["--at <S>"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0"], &["--omega <W>"]),
    (&["respond", "--q=0.5", "--e=0", "--at=1.5", "--omega=1"], &["--at", "1.5", "[-1, 1]"]),
    (&["respond", "--q=0.5", "--e=0", "--at=-1.00000000000001", "--omega=1"], &["--at", "-1.00000000000001", "[-1, 1]"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=0"], &["--omega", "0.0", "finite and > 0"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=-1"], &["--omega", "-1.0", "finite and > 0"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=nan"], &["--omega", "NaN", "finite and > 0"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--damping=-0.05"], &["--damping", "-0.05", "[0, 1e60]"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--damping=nan"], &["--damping", "NaN", "[0, 1e60]"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--q-factor=0"], &["--q-factor", "0.0", "1e-60"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--q-factor=1", "--damping=1"], &["--damping", "--q-factor", "cannot be used with"]),
    (&["respond", "--q=1", "--e=0.5", "--at=0.5", "--omega=1"], &["q = 1", "0.5", "only the center"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "-o", "x.npy"], &["--output", ".csv, .json or .svg"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--height-gap=0", "-o", "x.csv"], &["flat drop", "--height-gap"]),
    (&["respond", "--e=0", "--at=0", "--omega=1"], &["--q=Q, --gyration-ratio=K or --mass=M@S"]),
    (&["respond", "--omega=1"], &["--e <E>", "--at <S>"]),
    (&["respond", "--model=map", "--gyration-m=0.04", "--e=0", "--at=0", "--omega=1"], &["--length=LENGTH", "--speed=SPEED or --height=LENGTH", "--tilt=ANGLE"]),
    (&["respond", "--model=map", "--q=0.5", "--e=0", "--at=0", "--omega=1"], &["--model", "--q", "cannot be used with"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--tilt-deg=3"], &["--model <MODEL>"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--shocks-file=x.csv"], &["--shocks-file", "cannot be used with"]),
    (&["respond", "--shocks-file=x.csv", "--pulses-file=x.csv", "--omega=1"], &["--pulses-file", "cannot be used with"]),
    (&["respond", "--shocks-file=x.csv", "--omega=1", "-o", "x.svg"], &["--output", "cannot be used with"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--shock-table=1:2,3,4"], &["--equivalent-pulse"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--equivalent-pulse", "--shock-table=1,2,3"], &["--shock-table", "SHORTEST:LONGEST,ACCELERATION,VELOCITY_CHANGE"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--equivalent-pulse", "--shock-table=2:1,3,4"], &["--shock-table", "2 ms, is longer than the longest, 1 ms"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--equivalent-pulse", "--shock-table=1:2,nan,4"], &["--shock-table", "acceleration in g = NaN is not finite and > 0"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--omega=1", "--contact-time-s=1e-4", "--spin-rad-s=1"], &["unexpected argument '--spin-rad-s'"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--omega=1", "--contact-time-s=1e-4", "--impact-limit=1"], &["unexpected argument '--impact-limit'"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--omega=1", "--contact-time-s=1e-4", "--time-limit-s=1e-4"], &["unexpected argument '--time-limit-s'"]),
    (&["respond", "--q=0.5", "--e=0.3", "--at=1", "--omega=3", "--equivalent-pulse"], &["--equivalent-pulse", "SI units"]),
    (&["respond", "--model=map", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--damping=0.1"], &["--damping and --q-factor go with --omega"]),
    (&["respond", "--model=map", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--equivalent-pulse"], &["--omega <W>"]),
    (&["respond", "--model=map", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--tolerance=0"], &["--tolerance", "[1e-4, 0.5]"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0"], &["--contact-time=TIME"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--contact-time-s=0.1"], &["--contact-time-s", "0.1", "at most 4.66 ms here, a tenth of length/speed"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.001", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--contact-time-s=1e-4"], &["--gyration-m", "0.001", "at least 7 mm here, 0.05 of the length"]),
    (&["respond", "--model=compliant", "--length-m=0.14", "--gyration-m=0.04", "--thickness-m=0.01", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--contact-time-s=1e-4"], &["--thickness-m", "0.01", "compliant"]),
    (&["respond", "--model=finite-tilt", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--contact-time-s=1e-4", "--contact-law=dashpot"], &["--contact-law", "--model=compliant alone"]),
    (&["respond", "--model=map", "--length-m=0.14", "--gyration-m=0.04", "--e=0.3", "--speed-m-s=3", "--tilt-deg=4", "--at=0", "--omega=1e-245"], &["--omega", "1e-245", "[1e-12, 1e12]"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--tolerance=1%"], &["--model <MODEL>"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--omega=1", "--contact-law=dashpot"], &["--model <MODEL>"]),
    // Spectra: one excitation, and each of its numbers.
    (&["spectrum"], &["<RECORD|--pulse", "--shock"]),
    (&["spectrum", "--shock=1,0", "-o", "x.pdf"], &["x.pdf", ".csv, .json or .svg"]),
    (&["spectrum", "--shocks-file=x.csv", "--pulses-file=x.csv"], &["cannot be used with"]),
    (&["spectrum", "--pulse=rectangle,1,1", "--tests=x.csv"], &["--damage-boundary"]),
    (&["spectrum", "x.csv", "--pulse=half-sine,1,1"], &["cannot be used with"]),
    (&["spectrum", "--pulse=half-sine,1,1", "--shock=1,0"], &["cannot be used with"]),
    (&["spectrum", "--pulse=half-sine,1,0,0"], &["--pulse", "zero duration is a velocity shock", "--shock=DELTA_V_M_S,TIME_S"]),
    (&["spectrum", "--pulse=half-sine,1,-1,0"], &["--pulse", "duration = -1.0"]),
    (&["spectrum", "--pulse=half-sine,nan,1,0"], &["--pulse", "amplitude = NaN is not finite"]),
    (&["spectrum", "--pulse=half-sine,1,1,inf"], &["--pulse", "start = inf is not finite"]),
    (&["spectrum", "--pulse=half-sine,1e13,1,0"], &["--pulse", "amplitude = 10000000000000.0", "[1e-12, 1e12]"]),
    (&["spectrum", "--pulse=half-sine,1,1e-13,0"], &["--pulse", "duration = 1e-13", "[1e-12, 1e12]"]),
    (&["spectrum", "--shock=1,0", "--frequency=1e13"], &["--frequency", "[1e-12, 1e12]"]),
    (&["spectrum", "--pulse=half-sine,1,100,0", "--frequency=10000"], &["100.0 s", "100000 periods", "10000.0 Hz"]),
    (&["spectrum", "--pulse=half-sine,1"], &["--pulse", "SHAPE,AMPLITUDE_M_S2,DURATION_S,START_S"]),
    (&["spectrum", "--pulse=sine,1,1,0"], &["--pulse", "'sine' is no shape", "half-sine", "trapezoid:RAMP"]),
    (&["spectrum", "--pulse=trapezoid:0.6,1,1,0"], &["--pulse", "ramp over duration = 0.6", "(0, 0.5]"]),
    (&["spectrum", "--pulse=half-sine,1 kg,1,0"], &["--pulse", "\"kg\" is no unit of acceleration: one of m/s2, g"]),
    (&["spectrum", "--pulse=half-sine,1 g,1 mm,0"], &["--pulse", "\"mm\" is no unit of time: one of s, ms"]),
    (&["spectrum", "--shock=1,0", "--limit=1 kg"], &["--limit", "'1 kg' is not a number", "1500g"]),
    (&["spectrum", "--shock=1,0", "--limit=1500 g", "--quantity=pseudo-velocity"], &["--limit in g is an acceleration", "pseudo-velocity", "m/s"]),
    (&["spectrum", "--shock=1,0", "--limit=10:5g,100:2m/s"], &["--limit", "of one kind"]),
    (&["spectrum", "--shock=1,0", "--frequency=180 mm"], &["--frequency", "\"mm\" is no unit of frequency: one of Hz, kHz"]),
    // Quantities of a drop: the names with a unit take one, those of before a number alone.
    (&["simulate", "--model=map", "--length=0.15", "--gyration=40mm", "--e=0", "--speed=3m/s", "--tilt=4deg"], &["--length <LENGTH>", "\"0.15\" has no unit: one of m, mm, cm", "\"70 mm\""]),
    (&["simulate", "--model=map", "--length=150 kg", "--gyration=40mm", "--e=0", "--speed=3m/s", "--tilt=4deg"], &["--length", "\"kg\" is no unit of length: one of m, mm"]),
    (&["simulate", "--model=map", "--length=150mm", "--length-m=0.15", "--gyration=40mm", "--e=0", "--speed=3m/s", "--tilt=4deg"], &["--length", "--length-m", "cannot be used with"]),
    (&["simulate", "--model=map", "--length=150mm", "--gyration=40mm", "--e=0", "--speed=3m/s", "--tilt=100deg"], &["--tilt", "100", "[1e-60, 90)"]),
    (&["simulate", "--model=map", "--length=150mm", "--gyration=40mm", "--e=0", "--speed=3m/s", "--tilt=4deg", "--at=80mm"], &["--at 80 mm is beyond the ends", "75 mm"]),
    (&["simulate", "--component=display"], &["--product"]),
    (&["impacts", "--mass=1@5mm", "--e=0"], &["--mass", "half-lengths", "--length"]),
    (&["respond", "--q=0.5", "--e=0", "--at=5mm", "--omega=1"], &["--at", "half-lengths", "--length"]),
    (&["respond", "--q=0.5", "--e=0", "--at=0", "--frequency=180Hz"], &["--frequency needs SI units"]),
    // Standard output has no ending.
    (&["map", "impacts", "--q=0:1:2", "--e=0:1:2", "-o", "-"], &["--output", "- is standard output", ".csv, .json, .npy, .svg"]),
    (&["design", "-o", "-"], &["--output", "- is standard output", ".svg, .csv"]),
    (&["assess", "-", "-"], &["- is standard input, which can be read once"]),
    (&["report", "-o", "-"], &["--output", "several files"]),
    (&["spectrum", "--shock=1"], &["--shock", "DELTA_V_M_S,TIME_S"]),
    (&["spectrum", "--shock=inf,0"], &["--shock", "velocity change = inf is not finite"]),
    (&["spectrum", "--shock=1,2", "--shock=1,1"], &["velocity shocks, entry 2", "time 1.0 is before 2.0"]),
    (&["spectrum", "--shock=1,0", "--frequency=0"], &["--frequency", "entry 1", "0.0 is not finite and > 0"]),
    (&["spectrum", "--shock=1,0", "--frequency=10,-1"], &["--frequency", "entry 2", "-1.0 is not finite and > 0"]),
    (&["spectrum", "--shock=1,0", "--frequency=10,nan"], &["--frequency", "entry 2", "NaN is not finite and > 0"]),
    (&["spectrum", "--shock=1,0", "--frequency=10:20"], &["--frequency", "LO:HI:PER_OCTAVE"]),
    (&["spectrum", "--shock=1,0", "--frequency=20:10:3"], &["--frequency", "10.0 is not at least the lowest"]),
    (&["spectrum", "--shock=1,0", "--frequency=1:2:1e9"], &["--frequency", "at most 1e7"]),
    (&["spectrum", "--shock=1,0", "--frequency="], &["--frequency", "'' is not a number"]),
    (&["spectrum", "--shock=1,0", "--damping=-1"], &["--damping", "-1.0", "[0, 1e60]"]),
    (&["spectrum", "--shock=1,0", "--quantity=force"], &["--quantity", "force", "relative-velocity"]),
    (&["spectrum", "--shock=1,0", "--limit=0"], &["--limit", "0.0 is not finite and > 0"]),
    (&["spectrum", "--shock=1,0", "--limit=10:1"], &["--limit", "the limit curve has one point; it needs two at least"]),
    (&["spectrum", "--shock=1,0", "--limit=10:1,5:1"], &["--limit", "limit curve, entry 2", "5.0 is not finite and above the one before it"]),
    (&["spectrum", "--shock=1,0", "--limit=10:1,20"], &["--limit", "HZ:VALUE"]),
    (&["spectrum", "--shock=1,0", "--units=s,g"], &["--units goes with records alone"]),
    (&["spectrum", "x.csv", "--units=s"], &["--units", "TIME,ACCELERATION"]),
    (&["spectrum", "x.csv", "--units=kg,g"], &["--units", "'kg' is a unit of mass, not of time"]),
    (&["spectrum", "x.csv", "--units=s,foo"], &["--units", "'foo' is no unit of acceleration", "m/s2"]),
    (&["spectrum", "--shock=1,0", "--low-pass=100"], &["--low-pass goes with records alone"]),
    (&["spectrum", "x.csv", "--window=2:1"], &["--window", "from 2.0 s to 1.0 s is empty"]),
    (&["spectrum", "x.csv", "--sample-rate=0"], &["--sample-rate", "0.0 is not finite and > 0"]),
    (&["record"], &["<FILE>"]),
    (&["record", "x.csv", "--nominal=half-sine,1,1"], &["--fit-pulse"]),
    (&["record", "x.csv", "--threshold=1"], &["--find"]),
    (&["record", "no such file.csv"], &["no such file.csv: the record could not be read"]),
    (&["record", "x.csv", "-o", "x.png"], &["x.png", ".csv, .npy, .parquet or .svg"]),
    (&["spectrum", "no such file.csv"], &["no such file.csv: the record could not be read"]),
    (&["spectrum", "."], &[".: the record could not be read"]),
    (&["spectrum", "--shock=1,0", "--damage-boundary", "--limit=1"], &["--pulse"]),
    (&["spectrum", "--pulse=half-sine,1,1", "--damage-boundary", "--frequency=1"], &["--limit of one value"]),
    (&["spectrum", "--pulse=half-sine,1,1", "--damage-boundary", "--limit=1"], &["one --pulse", "one --frequency"]),
    (&["spectrum", "--pulse=half-sine,1,1,0,2", "--damage-boundary", "--limit=1", "--frequency=1"], &["one --pulse"]),
    (&["spectrum", "--pulse=half-sine,1,1", "--damage-boundary", "--limit=1:1,2:2", "--frequency=1"], &["--limit of one value"]),
    (&["spectrum", "--pulse=half-sine,1,1", "--damage-boundary", "--limit=1", "--frequency=1", "--quantity=pseudo-velocity"], &["acceleration and relative-displacement"]),
    // Design and scatter.
    (&["design", "x.toml", "--margin=many"], &["--margin", "'many' is not a share"]),
    (&["design", "x.toml", "--margin=-1%"], &["--margin", "-0.01", "[0, 100]"]),
    (&["design", "--zone=0.5"], &["--zone", "0.5", "X:S"]),
    (&["design", "--zone=0.5:2"], &["--zone", "2.0", "[0, 1]"]),
    (&["design", "--zone=nan:0.1"], &["--zone", "NaN", "[1e-150, 1e150]"]),
    (&["design", "--turn=1"], &["--zone=X:S"]),
    (&["design", "--turn=-1", "--zone=1:0"], &["--turn", "-1", "1e-150"]),
    (&["design", "--q=0.9:0.1"], &["--q", "0.9:0.1", "[0, 1]"]),
    (&["design", "--e=0:nan"], &["--e", "0.0:NaN", "[0, 1]"]),
    (&["design", "--frequency-factor=1"], &["--frequency-factor", "1", "above 1"]),
    (&["design", "--damping=0:11"], &["--damping", "11", "[0, 10]"]),
    (&["design", "-o", "plane.png"], &["plane.png", ".svg or .csv"]),
    (&["design", "--front=front"], &["front", ".svg or .csv"]),
    (&["design", "nowhere.toml"], &["cannot read nowhere.toml"]),
    (&["design", "nowhere.toml", "--zone=1:0"], &["--zone", "cannot be used with"]),
    (&["assess", "nowhere.toml", "-o", "x.txt"], &["x.txt", "the file must end in .pdf"]),
    (&["assess", "nowhere.toml", "--output=pdf"], &["--output", "the file must end in .pdf"]),
    (&["assess", "nowhere.toml", "-o", ""], &["--output", "the file must end in .pdf"]),
    (&["scatter"], &["<PRODUCT.toml>"]),
    (&["scatter", "nowhere.toml"], &["cannot read nowhere.toml"]),
    (&["scatter", "x.toml", "--samples=0"], &["--samples", "'0'", "1 to 1e12"]),
    (&["scatter", "x.toml", "--samples=1.5"], &["--samples", "'1.5'", "1 to 1e12"]),
    (&["scatter", "x.toml", "--samples=2e12"], &["--samples", "'2e12'", "1 to 1e12"]),
    (&["scatter", "x.toml", "--seed=-1"], &["--seed", "'-1'", "whole number"]),
    (&["scatter", "x.toml", "--confidence=1"], &["--confidence", "'1'", "between 0 and 1"]),
    (&["scatter", "x.toml", "--target=100%"], &["--target", "1.0", "between 0 and 1"]),
    (&["scatter", "x.toml", "--target=sure"], &["--target", "'sure' is not a share"]),
    (&["scatter", "x.toml", "-o", "x.json"], &["x.json", ".csv"]),
    // The command itself.
    (&["report", "novel"], &["novel", "paper, shock, accuracy, all"]),
    (&["completions", "tcsh"], &["tcsh", "bash"]),
    (&["bounce"], &["bounce"]),
    (&["impacts", "--q=0.5", "--e=0", "--mass=1"], &["--mass"]),
];

#[test]
fn is_refused_with_one_message_that_says_what_is_allowed() {
    let rows = REFUSED.iter().map(|(arguments, said)| (arguments.iter().map(|&a| a.to_owned()).collect(), *said));
    are_refused(rows);
}

/// Each row: arguments, and what the one message has to say.
pub(crate) fn are_refused<'a>(rows: impl IntoIterator<Item = (Vec<String>, &'a [&'a str])>) {
    let (mut wrong, mut all) = (Vec::new(), 0);
    for (arguments, said) in rows {
        all += 1;
        let outcome = clatter(&arguments);
        let clean = outcome.exit == Exit::BadInput
            && outcome.stdout.is_empty()
            && outcome.stderr.starts_with("error: ")
            && outcome.stderr.matches("error: ").count() == 1
            && said.iter().all(|part| outcome.stderr.contains(part));
        if !clean {
            wrong.push(format!("clatter {arguments:?} ({:?})\n{}{}", outcome.exit, outcome.stdout, outcome.stderr));
        }
    }
    assert!(wrong.is_empty(), "{} of {all} are not as they should be:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn no_command_at_all_shows_the_help_and_fails() {
    let outcome = clatter::<&str>([]);
    assert_eq!((outcome.exit, outcome.stdout.as_str()), (Exit::BadInput, ""));
    assert!(outcome.stderr.contains("Usage: clatter [OPTIONS] <COMMAND>"), "{}", outcome.stderr);
}
