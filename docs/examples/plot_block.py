"""Draws a block's place and speed over time: plot_block.py block.csv block.png"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import pandas

data = pandas.read_csv(sys.argv[1])
figure, (place, speed) = plt.subplots(2, sharex=True, layout="constrained")
place.plot(data["time [s]"], 1e3 * data["block.p_x [m]"])
place.set_ylabel("place [mm]")
speed.plot(data["time [s]"], data["block.v_x [m/s]"])
speed.set_ylabel("speed [m/s]")
speed.set_xlabel("time [s]")
figure.savefig(sys.argv[2], dpi=120)
