"""One short run as other software writes it: numpy, scipy, pyarrow, and the formats' documents.

    pip install numpy scipy pyarrow
    python logs.py            # writes the files beside it

The IMU turns by W and feels F along right, front and up, another rate in each of 24 samples of 10 ms, the first of which ends
at 10 ms. The tests say the same in their own words. Last made with numpy 2.x, scipy 1.17.1 and pyarrow 26.0.1 by Python 3.
"""

import os
import zlib

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io

os.chdir(os.path.dirname(os.path.abspath(__file__)))

STEP = 0.01
k = np.arange(1, 25)
t = k * STEP
W = np.column_stack([0.1 + 0.001 * k, 0.2 - 0.002 * k, 0.3 + 0.003 * k])  # rad/s
F = np.column_stack([1.0 + 0.01 * k, 2.0 - 0.02 * k, 9.8 + 0.03 * k])  # m/s^2
right, front, up = 0, 1, 2

# PSINS: rows of seven doubles, angle and velocity increments and time.
np.column_stack([W * STEP, F * STEP, t]).tofile("psins.bin")

# KF-GINS: time, and increments along front, right and down.
frd = [front, right, up]
signs = np.array([1, 1, -1])
rows = np.column_stack([t, W[:, frd] * signs * STEP, F[:, frd] * signs * STEP])
np.savetxt("kf_gins.txt", rows, fmt="%.17g")

# EuRoC: nanoseconds since 1970, rates and specific force.
ns = 1403636579758555392 + k * 10_000_000
with open("euroc.csv", "w") as file:
    file.write(
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
        "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
    )
    for row in range(24):
        file.write(",".join([str(ns[row])] + [repr(float(v)) for v in [*W[row], *F[row]]]) + "\n")

# NovAtel: counts along up, -front, right; of an HG1700-AG58 and, as rates, of an Epson G320.
def message(name, body):
    text = f"{name},2209,491612.254;{body}"
    crc = zlib.crc32(text.encode(), 0xFFFFFFFF) ^ 0xFFFFFFFF
    return f"%{text}*{crc:08x}\r\n"


def counts(velocity, angle, row):
    order = [(velocity[row, up]), -velocity[row, front], velocity[row, right]]
    order += [angle[row, up], -angle[row, front], angle[row, right]]
    return ",".join(str(round(v)) for v in order)


foot = 0.3048
with open("novatel.asc", "w", newline="") as file:
    file.write("#INSPVAA,COM1,0,0.0,FINESTEERING,2209,491612.0,0,0,0;not,of,interest*00000000\r\n")
    for row in range(24):
        values = counts(F * STEP * 2**27 / foot, W * STEP * 2**33, row)
        file.write(message("RAWIMUSA", f"2209,{604799.9 + t[row]:.6f},00000077,{values}" if t[row] < 0.1 else
                           f"2210,{t[row] - 0.1:.6f},00000077,{values}"))
with open("novatel_epson.asc", "w", newline="") as file:
    for row in range(24):
        values = counts(F / 9.80665 * 1e3 / 0.2 * 65536, np.degrees(W) / 0.008 * 65536, row)
        file.write(message("RAWIMUSXA", f"00,41,2209,{491612 + t[row]:.6f},00000077,{values}"))

# MATLAB: a structure as NaveGo keeps it and a matrix as PSINS does, compressed and not.
imu = np.column_stack([W * STEP, F * STEP, t])
navego = {"t": t[:, None], "wb": W, "fb": F, "freq": 100.0, "ini": "text"}
everything = {"about": "a run", "imu": imu, "navego": navego, "counts": np.int16(imu * 1000), "t": t, "z": imu + 1j}
scipy.io.savemat("v7.mat", everything, do_compression=True)
scipy.io.savemat("v6.mat", everything, do_compression=False)
scipy.io.savemat("v4.mat", {"imu": imu}, format="4")

# Parquet: floats, time in integers, missing values, several row groups and codecs.
names = ["gx", "gy", "gz", "ax", "ay", "az"]
table = {"t": pa.array(ns, pa.timestamp("ns"))}
table |= {name: pa.array(column) for name, column in zip(names, np.column_stack([W, F]).T)}
table |= {"single": pa.array(W[:, 0].astype(np.float32)), "word": pa.array(["x"] * 24), "hole": pa.array([1.0] * 9 + [None] + [1.0] * 14)}
table |= {"count": pa.array(k.astype(np.uint32)), "list": pa.array([[1.0]] * 24)}
table = pa.table(table)
pq.write_table(table, "snappy.parquet", row_group_size=10, compression="snappy")
pq.write_table(table, "gzip.parquet", compression="gzip", data_page_version="2.0", use_dictionary=False)
pq.write_table(table, "plain.parquet", compression="none", use_dictionary=False, column_encoding={"gx": "BYTE_STREAM_SPLIT", "t": "DELTA_BINARY_PACKED"})
pq.write_table(table, "zstd.parquet", compression="zstd")
