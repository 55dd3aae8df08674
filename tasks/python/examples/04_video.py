# %% [markdown]
# # A video, without a display
# Pictures are drawn in memory (EGL) and given to ffmpeg.

# %%
import pathlib
import shutil
import subprocess
import tempfile

import pincer

model = pincer.load("pickup")
state = pincer.State(model)
renderer = pincer.Renderer(model, width=320, height=240)
camera = pincer.Camera(yaw=0.6, pitch=0.3)
per_second, seconds = 25, 2

# %%
frames = []
for _ in range(per_second * seconds):
    pincer.step(model, state, nstep=round(1 / per_second / model.tick))
    frames.append(renderer.render(state, camera))
print(len(frames), "frames of", frames[0].shape)

# %%
if shutil.which("ffmpeg"):
    video = pathlib.Path(tempfile.mkdtemp()) / "pickup.mp4"
    command = [
        "ffmpeg",
        "-loglevel",
        "error",
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-s",
        "320x240",
        "-r",
        str(per_second),
        "-i",
        "-",
        "-pix_fmt",
        "yuv420p",
        str(video),
    ]
    subprocess.run(command, input=b"".join(frame.tobytes() for frame in frames), check=True)
    print(video, video.stat().st_size, "bytes")
    assert video.stat().st_size > 5000
assert frames[0].std() > 5 and (frames[0] != frames[-1]).any()
