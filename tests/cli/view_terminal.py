"""view_terminal.py KRS: drives `krs view --terminal` on a pseudo-terminal, and says in TAP what came of it."""
import fcntl, os, pty, re, select, struct, subprocess, sys, termios, time

krs, number = sys.argv[1], 0
COLUMNS, ROWS = 40, 14  # two of them for text


def result(good, what):
    global number
    number += 1
    print(("ok" if good else "not ok"), number, "-", what, flush=True)


def scene(radius, color):
    with open("scene.new", "w") as file:
        file.write("camera { eye: [0, 1, 5], target: [0, 0, 0], fov: 40deg }\n"
                   "light { direction: [-0.5, 1, 0.6], intensity: 2.5 }\n"
                   f"show sphere({radius}).paint({color});\n")
    os.rename("scene.new", "scene.krs")


def start():
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM="xterm-256color", COLORTERM="truecolor")
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        os.execv(krs, [krs, "view", "scene.krs", "--terminal", "--samples", "1"])
    return child, terminal


def read(seconds):
    said, until = b"", time.time() + seconds
    while time.time() < until:
        if select.select([terminal], [], [], 0.05)[0]:
            try:
                said += os.read(terminal, 65536)
            except OSError:
                break
    return said.decode(errors="replace")


def colors(said):
    """The mean colour of the cells of the last whole picture, or None."""
    frames = [frame for frame in said.split("\033[H") if "\033[0m" in frame]
    found = [tuple(map(int, color)) for frame in frames[-1:]
             for color in re.findall(r"[34]8;2;(\d+);(\d+);(\d+)", frame)]
    return [sum(channel) / len(found) for channel in zip(*found)] if found else None


def wait_for(what, seconds=30):
    """What was said when this holds of it, or of what came last."""
    said, until = "", time.time() + seconds
    while time.time() < until:
        said += read(0.2)
        if what(said):
            return said
    return None


def rendered():
    """The mean colour of a picture of the same size, where the ball is or not."""
    picture = subprocess.run([krs, "render", "scene.krs", "--size", f"{4 * COLUMNS}x{8 * (ROWS - 2)}",
                              "--specialize", "structure", "--raw"], capture_output=True).stdout
    return [sum(picture[channel::3]) / len(picture[channel::3]) for channel in range(3)]


def near(said, meant):
    mean = colors(said)
    return mean and all(abs(a - b) < 20 for a, b in zip(mean, meant))


scene(1, "#ff4000")
meant = rendered()
child, terminal = start()
said = wait_for(lambda said: "160x96   1/1" in said and near(said, meant))
result(said, "the picture is drawn with the colours of a render")
read(0.5)
os.write(terminal, b"\033[C")
turned = wait_for(lambda said: "160x96   1/1" in said)
result(turned, "a key turns the camera")
os.write(terminal, b"v")
result(wait_for(lambda said: "1/1   depth" in said), "another shows depths")
for _ in range(7):
    os.write(terminal, b"v")
os.write(terminal, b"h")
read(0.5)
scene(1.7, "#20c040")
meant = rendered()
result(wait_for(lambda said: near(said, meant)), "an edit is followed")
with open("scene.krs", "w") as file:
    file.write("show spere(1);")
result(wait_for(lambda said: "scene.krs:1: error" in said), "a mistake is told")
os.write(terminal, b"?")
result(wait_for(lambda said: "W A S D E Q" in said), "a key shows the help")
os.write(terminal, b"?")
read(0.3)
os.write(terminal, b"\033")
said = wait_for(lambda said: "\033[?1049l" in said, 10)
ended, status = os.waitpid(child, 0)
result(said and status == 0, "Esc ends it, and leaves the screen as it was")
