"""vulkan_faults_view.py KRS SCENE: prints how `krs view --terminal` ends, and what it says on standard error, when Esc is
pressed after a second of pictures, or when it has ended by itself."""
import fcntl, os, pty, select, struct, sys, termios, time

krs, scene = sys.argv[1:]
read_end, write_end = os.pipe()
child, terminal = pty.fork()
if child == 0:
    os.environ.update(TERM="xterm-256color", COLORTERM="truecolor")
    fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 14, 40, 0, 0))
    os.dup2(write_end, 2)
    os.execv(krs, [krs, "view", scene, "--terminal", "--samples", "16"])
os.close(write_end)
pictures, pressed, begun = b"", None, time.time()
while True:
    ended, status = os.waitpid(child, os.WNOHANG)
    if ended:
        break
    if time.time() - begun > 120:
        os.kill(child, 9)
    if select.select([terminal], [], [], 0.1)[0]:
        try:
            pictures += os.read(terminal, 65536)
        except OSError:
            pass
    if b"8;2;" in pictures and pressed is None:
        pressed = time.time() + 1
    if pressed is not None and time.time() > pressed:
        os.write(terminal, b"\033")
        pressed = time.time() + 1e9
os.set_blocking(read_end, False)
try:
    said = os.read(read_end, 65536).decode(errors="replace")
except BlockingIOError:
    said = ""
print("status", os.waitstatus_to_exitcode(status), "pictures" if b"8;2;" in pictures else "no picture")
print(said, end="")
