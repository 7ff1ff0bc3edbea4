"""view_terminal.py KRS: drives `krs view --terminal` on a pseudo-terminal, and says in TAP what came of it."""
import base64, fcntl, os, pty, re, select, struct, subprocess, sys, termios, time

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


def start(term, cell_width=0, cell_height=0, shown="scene.krs"):
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM=term, COLORTERM="truecolor")
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, COLUMNS * cell_width,
                                                       ROWS * cell_height))
        os.execv(krs, [krs, "view", shown, "--terminal", "--samples", "1"])
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


def rendered(width=4 * COLUMNS, height=8 * (ROWS - 2)):
    """The mean colour of a picture of the same size, where the ball is or not."""
    picture = subprocess.run([krs, "render", "scene.krs", "--size", f"{width}x{height}",
                              "--specialize", "structure", "--raw"], capture_output=True).stdout
    return [sum(picture[channel::3]) / len(picture[channel::3]) for channel in range(3)]


def near(said, meant):
    mean = colors(said)
    return mean and all(abs(a - b) < 20 for a, b in zip(mean, meant))


scene(1, "#ff4000")
meant = rendered()
child, terminal = start("xterm-256color")
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


# ---- terminals that show pixels ----

CELL_WIDTH, CELL_HEIGHT = 6, 12
WIDTH, HEIGHT = COLUMNS * CELL_WIDTH, (ROWS - 2) * CELL_HEIGHT


def kitty_picture(said):
    """Width, height and mean colour of the last picture of kitty's protocol."""
    last = said[said.rindex("a=T"):] if "a=T" in said else ""
    size = re.match(r"a=T,f=32,s=(\d+),v=(\d+)", last)
    data = b"".join(map(base64.b64decode, re.findall(r"\033_Gm=\d;([^\033]*)\033", last)))
    count = int(size[1]) * int(size[2]) if size else 0
    if not count or len(data) != 4 * count:
        return None
    return int(size[1]), int(size[2]), [sum(data[channel::4]) / count for channel in range(3)]


def sixel_picture(said):
    """The same of a sixel picture: a character is six pixels of a column, in the chosen colour."""
    pictures = re.findall(r'\033P[0-9;]*q"1;1;(\d+);(\d+)(.*?)\033\\', said, re.S)
    if not pictures:
        return None
    palette, pixels, x, y, times = {}, {}, 0, 0, 1
    for color, rgb, repeat, sign in re.findall(r"#(\d+)((?:;\d+)*)|!(\d+)|([?-~$-])", pictures[-1][2]):
        if color:
            chosen = color
            if rgb:
                palette[color] = [int(part) * 2.55 for part in rgb.split(";")[2:]]
        elif repeat:
            times = int(repeat)
        elif sign == "$":
            x = 0
        elif sign == "-":
            x, y = 0, y + 6
        else:
            for _ in range(times):
                for bit in range(6):
                    if ord(sign) - 63 >> bit & 1:
                        pixels[x, y + bit] = palette[chosen]
                x += 1
            times = 1
    count = int(pictures[-1][0]) * int(pictures[-1][1])
    means = [sum(channel) / count for channel in zip(*pixels.values())]
    return int(pictures[-1][0]), int(pictures[-1][1]), means


def shows(said, picture):
    """Whether the last picture has the terminal's pixels, and the colours of a render."""
    found = f"{WIDTH}x{HEIGHT}   1/1" in said and picture(said)
    return (found and found[:2] == (WIDTH, HEIGHT) and
            all(abs(a - b) < 3 for a, b in zip(found[2], meant)))


scene(1, "#ff4000")
meant = rendered(WIDTH, HEIGHT)
for term, picture in ("xterm-kitty", kitty_picture), ("foot", sixel_picture):
    child, terminal = start(term, CELL_WIDTH, CELL_HEIGHT)
    result(wait_for(lambda said: shows(said, picture)), f"{term} shows each pixel of a render")
    os.write(terminal, b"\033")
    wait_for(lambda said: "\033[?1049l" in said, 10)
    os.waitpid(child, 0)

# ---- a scene in a pack ----

meant = rendered()
subprocess.run([krs, "pack", "scene.krs", "-o", "ball.krsz", "--quiet"], check=True)
with open("scene.krs", "w") as file:
    file.write("show box([1, 1, 1]);")
child, terminal = start("xterm-256color", shown="ball.krsz")
result(wait_for(lambda said: "160x96   1/1" in said and near(said, meant)), "a pack is shown, and no file beside it")
os.write(terminal, b"\x05")
result(wait_for(lambda said: "in a pack" in said), "the camera is not written into it")
os.write(terminal, b"\033")
wait_for(lambda said: "\033[?1049l" in said, 10)
ended, status = os.waitpid(child, 0)
with open("scene.krs") as file:
    result(status == 0 and file.read() == "show box([1, 1, 1]);", "nor into the file")
