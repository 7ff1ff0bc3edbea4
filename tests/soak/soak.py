"""soak.py: tries krs for hours, with what no suite has the time for, and counts what it tried and found.

    soak.py [--hours N] [--seconds N] [--seed N] [--only KIND] [--count N] [--build DIR] [--row FILE]

Each execution of a kind has a seed of its own: `--only KIND --seed N --count 1` repeats it.  A finding is a crash, a hang, a
message of a sanitizer, a status that no one promises, more or less than a clear line, half a file, or another picture
than is expected; its folder stays.  The kinds are the functions below `# ---- kinds ----`.
"""
import argparse, datetime, glob, os, random, re, shutil, signal, subprocess, sys, tempfile, time

root = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
arguments = argparse.ArgumentParser()
arguments.add_argument("--hours", type=float, default=0)
arguments.add_argument("--seconds", type=float, default=0)
arguments.add_argument("--seed", type=int, default=int(time.time()))
arguments.add_argument("--only", action="append", default=[])
arguments.add_argument("--count", type=int, default=10**9)
arguments.add_argument("--build", default="build")
arguments.add_argument("--row")
arguments.add_argument("--planted", action="store_true", help="krs crashes: shows that this is found")
options = arguments.parse_args()
build = os.path.abspath(options.build)
krs = os.path.join(build, "krs")
kept = os.path.join(build, "soak-findings")
row = options.row and os.path.abspath(options.row)
work = tempfile.mkdtemp(prefix="krs-soak-")
tools = os.path.join(work, "tools")
os.mkdir(tools)
counts, failures = {}, []


class Finding(Exception):
    pass


class Skip(Exception):
    pass


def compiled(name, source, *flags):
    """A shared object of the tests."""
    path = os.path.join(tools, name)
    if not os.path.exists(path):
        command = [os.environ.get("CC", "cc"), "-std=c17", "-D_GNU_SOURCE", "-shared", "-fPIC", "-o", path,
                   os.path.join(root, source), *flags]
        if subprocess.run(command, stderr=subprocess.DEVNULL).returncode:
            raise Skip(f"{source} does not compile")
    return path


environment = dict(os.environ, XDG_CACHE_HOME=os.path.join(work, "cache"), ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=1",
                   TSAN_OPTIONS="halt_on_error=0 suppressions=" + os.path.join(root, "tests/soak/tsan.txt"))
if options.planted:
    environment["KRS_TEST_CRASH"] = "compile"


def run(command, timeout=120, stdin=b"", **more):
    """Status, standard output and error; a run that does not end is a finding."""
    environ = {**environment, "TMPDIR": os.path.abspath("tmp"), **more}
    os.makedirs("tmp", exist_ok=True)
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environ,
                               start_new_session=True)
    try:
        out, err = process.communicate(stdin, timeout)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise Finding(f"hangs: {' '.join(command)}")
    return process.returncode, out, err.decode(errors="replace")


# What a run may end with: done, a wrong scene, usage, no device, the driver, memory, files, to be resumed.
PROMISED = {0, 1, 2, 69, 70, 71, 73, 74, 75}


def judge(ran, allowed=PROMISED, outputs=()):
    """A run ends as it promises; where it fails, the outputs are not there."""
    status, _, err = ran
    if status not in allowed:
        raise Finding(f"status {status}: {err[-600:]}")
    starved = status == 71 and "for want of memory" in err  # libraries abort then
    if ("crashed" in err and not starved) or "Sanitizer" in err or "runtime error:" in err or (status and not err.strip()):
        raise Finding(f"status {status}: {err[-1500:]}")
    if status and any(os.path.exists(path) for path in outputs):
        raise Finding(f"status {status} and half a file: {err[-600:]}")
    if glob.glob(".krs-*"):
        raise Finding(f"status {status} and a temporary file")
    return status


def write(path, text):
    with open(path, "wb" if isinstance(text, bytes) else "w") as file:
        file.write(text)
    return path


def read(path):
    with open(path, "rb") as file:
        return file.read()


# ---- valid scenes ----

HEAD = "camera { eye: [3, 2, 5], target: [0, 0, 0], fov: 40deg }\nlight sun { direction: [-1, 2, 1], intensity: 3 }\n"


def vector(r, least=-1.0, most=1.0):
    return "[" + ", ".join(f"{r.uniform(least, most):.3g}" for _ in range(3)) + "]"


def shape(r, depth):
    """A solid, as a text in parentheses or of one call, so that methods may follow."""
    size = f"{r.uniform(0.3, 1.2):.3g}"
    if depth == 0:
        return r.choice([f"sphere({size})", f"box({vector(r, 0.3, 1.5)})", f"torus({size}, 0.2)", f"cylinder(0.4, {size})",
                         f"cone(0.5, {size})", f"capsule({vector(r)}, {vector(r)}, 0.2)"])
    a, b = shape(r, r.randrange(depth)), shape(r, r.randrange(depth))
    return r.choice([f"({a} | {b})", f"({a} & {b})", f"({a} - {b})", f"union({a}, {b}, blend: 0.2)", f"{a}.move({vector(r)})",
                     f"{a}.rotate({vector(r, 0.1)}, {r.randrange(360)}deg)", f"{a}.scale({size})", f"{a}.twist([0, 1, 0], rate: 0.3)",
                     f"{a}.paint({vector(r, 0)})"])


def scene(r, depth=4):
    return HEAD + "".join(f"show {shape(r, r.randrange(depth))};\n" for _ in range(r.randint(1, 3)))


def pixels(text, *how, **more):
    """A picture's bytes; scenes of numbers that are refused are none."""
    status, out, err = ran = run([krs, "render", write(f"{abs(hash(text))}.krs", text), "--raw", "--quiet", "--rays", "kernels",
                                  "--size", "32x24", *how], **more)
    if judge(ran, {0, 1}):
        raise Skip(err)
    return out


# ---- kinds ----


def language(r, seed):
    """Valid scenes through all of the compiler, a small render, a mesh; formatting changes no meaning."""
    path = write("scene.krs", scene(r))
    if judge(run([krs, "check", path]), {0, 1}):
        raise Skip("refused")
    judge(run([krs, "validate", path, "--points", "2000", "--seed", str(seed)]), {0})
    judge(run([krs, "render", path, "--size", "16x12", "--quiet", "-o", "a.exr"]), {0}, ["a.exr"])
    judge(run([krs, "mesh", path, "--error", "0.2", "--quiet", "-o", "a.stl"]), {0, 1}, ["a.stl"])
    judge(run([krs, "slice", path, "--layer", "0.3", "--quiet", "-o", "a.svg"]), {0, 1}, ["a.svg"])
    judge(run([krs, "grid", path, "--cell", "0.2", "--quiet", "-o", "a.npy"]), {0, 1}, ["a.npy"])


def grammar(r, seed):
    """1,000 sentences of the grammar, parsed and formatted."""
    program = os.path.join(build, "tests/fuzz/sentences")
    if not os.path.exists(program):
        raise Skip("not built")
    os.chdir(root)
    status, out, _ = run([program, "1000", str(seed)])
    if status:
        raise Finding(out.decode()[-600:])
    return 1000


def fuzz(r, seed, harness):
    program = os.path.join(build, "fuzz/tests/fuzz", harness)
    if not os.path.exists(program):
        raise Skip("not built")
    os.makedirs("seeds")
    for path in glob.glob(os.path.join(root, "examples/*.krs")) + glob.glob(os.path.join(root, "tests/errors/*.krs")):
        if os.path.getsize(path) < 3000 and b".." not in read(path):
            shutil.copy(path, "seeds/")
    status, _, err = run([program, f"-seed={seed % 2**31 + 1}", "-max_total_time=60", "-timeout=120", "-rss_limit_mb=4096",
                          "-max_len=4096", "-artifact_prefix=./", "seeds"], 400)
    if status:
        raise Finding(err[-1500:])
    return int(re.search(r"Done (\d+) runs", err).group(1))


def front_fuzz(r, seed):
    """The front end under libFuzzer and sanitizers, for a minute."""
    return fuzz(r, seed, "front_fuzz")


def scene_fuzz(r, seed):
    """The whole compiler but glslang likewise."""
    return fuzz(r, seed, "scene_fuzz")


def samples(r):
    """Files of each reader: what reads them."""
    small = write("good.krs", HEAD + "show sphere(1);\n")
    if not os.path.exists(os.path.join(tools, "a.exr")):
        judge(run([krs, "render", small, "--size", "16x12", "--quiet", "-o", os.path.join(tools, "a.exr"), "-o",
                   os.path.join(tools, "a.png")]), {0})
        judge(run([krs, "pack", small, "-o", os.path.join(tools, "a.krsz")]), {0, 2})
    exr, png = os.path.join(tools, "a.exr"), os.path.join(tools, "a.png")
    scenes = [path for path in glob.glob(os.path.join(root, "examples/0*.krs")) + glob.glob(os.path.join(root, "tests/errors/*.krs"))
              if os.path.getsize(path) < 4000]
    texture = write("texture.krs", HEAD + 'let t = texture("bad.png");\nshow sphere(1).paint(t(x, y));\n')
    hdr = write("texture_exr.krs", HEAD + 'let t = texture("bad.exr");\nshow sphere(1).paint(t(x, y));\n')
    letters = write("svg.krs", HEAD + 'show drawing("bad.svg").extrude(0.2);\n')
    font = write("font.krs", HEAD + 'show text("Ag", font: "bad.ttf").extrude(0.2);\n')
    render = ["--size", "16x12", "--samples", "1", "--quiet", "-o", "out.png"]
    found = [
        (read(r.choice(scenes)), "bad.krs", ["check", "bad.krs"]),
        (read(r.choice(scenes)), "bad.krs", ["format", "bad.krs", "--check"]),
        (read(png), "bad.png", ["check", texture]),
        (read(exr), "bad.exr", ["check", hdr]),
        (read(exr), "bad.exr", ["render", small, "--depth-in", "bad.exr", *render]),
        (read(exr), "bad.exr", ["render", small, "--plate", "bad.exr", *render]),
        (read(exr), "bad.exr", ["merge", "bad.exr", exr, "-o", "out.exr"]),
        (read(os.path.join(root, "examples/logo.svg")), "bad.svg", ["check", letters]),
        (read(os.path.join(root, "examples/logo.svg")), "bad.svg", ["import", "bad.svg"]),
        (read(os.path.join(root, "bench/radiosity/room.pov")), "bad.pov", ["import", "bad.pov"]),
        (b"group() { multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { difference() { sphere($fn = 0, "
         b"$fa = 12, $fs = 2, r = 1); cube(size = [1, 2, 3], center = true); } } }\n", "bad.csg", ["import", "bad.csg"]),
        (b"_0 var-x\n_1 var-y\n_2 square _0\n_3 square _1\n_4 add _2 _3\n_5 const 1\n_6 sub _4 _5\n", "bad.vm", ["import", "bad.vm"]),
        (b"f := x^2 + y^2 + z^2 - a; a := 0.5; set_parameter_range(a, 0, 1);\n", "bad.jsurf", ["import", "bad.jsurf"]),
    ]
    for path in glob.glob("/usr/share/fonts/truetype/*/*Mono.ttf")[:1]:
        found.append((read(path), "bad.ttf", ["check", font]))
    if os.path.exists(os.path.join(tools, "a.krsz")):
        found.append((read(os.path.join(tools, "a.krsz")), "bad.krsz", ["check", "bad.krsz"]))
    return found


def mutated(r, data):
    """The bytes with some changed, taken out, doubled or cut off."""
    data = bytearray(data)
    for _ in range(1 << r.randrange(5)):
        at = r.randrange(len(data)) if data else 0
        length = 1 << r.randrange(6)
        if r.random() < 0.5:
            data[at:at + 1] = bytes([r.choice([0, 1, 0x7F, 0x80, 0xFF, r.randrange(256)])])
        else:
            data[at:at + length] = r.choice([b"", data[at:at + length] * 2, bytes(r.randrange(256) for _ in range(length)),
                                             str(r.choice([0, -1, 2**31, 2**32, 1e999, 1e-300])).encode()])
    return bytes(data[:r.randrange(len(data) + 1)] if r.random() < 0.1 else data)


def readers(r, seed):
    """Every reader of files with spoilt ones, under sanitizers where krs is built with them (make sanitize)."""
    sanitized = os.path.join(build, "asan/krs")
    data, path, command = r.choice(samples(r))
    write(path, mutated(r, data))
    judge(run([sanitized if os.path.exists(sanitized) else krs, *command]), PROMISED - {70}, ["out.png", "out.exr"])


def language_server(r, seed):
    """Spoilt messages to the language server."""
    said = b""
    for i in range(20):
        body = r.choice([b'{"jsonrpc":"2.0","id":1,"method":"initialize","params":{}}',
                         b'{"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":{"uri":"file:///a.krs",'
                         b'"languageId":"krs","version":1,"text":"show sphere(1);"}}}',
                         b'{"jsonrpc":"2.0","id":2,"method":"textDocument/hover","params":{"textDocument":{"uri":"file:///a.krs"},'
                         b'"position":{"line":0,"character":6}}}'])
        body = mutated(r, body) if r.random() < 0.5 else body
        said += b"Content-Length: %d\r\n\r\n" % (len(body) + (r.randrange(-3, 4) if r.random() < 0.1 else 0)) + body
    sanitized = os.path.join(build, "asan/krs")
    status, out, err = run([sanitized if os.path.exists(sanitized) else krs, "lsp"], stdin=said)
    judge((status if status != 1 else 0, out, err))  # 1: it ends without having been asked to


def job(r):
    """A command that reads, computes and writes, and its output."""
    path = write("scene.krs", HEAD + r.choice(["show sphere(1);\n", 'show text("A").extrude(0.3);\n', "show box([1, 1, 1]) - sphere(0.7);\n"]))
    return r.choice([(["render", path, "--size", "16x12", "--quiet", "--deadline", "20", "-o", "out.exr"], "out.exr"),
                     (["render", path, "--size", "16x12", "--quiet", "--deadline", "20", "--resume", "-o", "out.png"], "out.png"),
                     (["mesh", path, "--error", "0.2", "--quiet", "-o", "out.3mf"], "out.3mf"),
                     (["mesh", path, "--error", "0.2", "--quiet", "-o", "out.glb"], "out.glb"),
                     (["slice", path, "--layer", "0.3", "--quiet", "-o", "out.svg"], "out.svg"),
                     (["grid", path, "--cell", "0.2", "--quiet", "-o", "out.npy"], "out.npy"),
                     (["export", path, "--to", "glsl", "-o", "out.glsl"], "out.glsl")])


def whole_or_clear(command, output, whole, allowed, wrap=(), **more):
    """Runs a command that is disturbed: its output is that of an undisturbed one, or it tells why not."""
    if os.path.exists(output):
        os.unlink(output)
    ran = run([*wrap, krs, *command], **more)
    if judge(ran, allowed, [output]) == 0 and (not os.path.exists(output) or len(read(output)) != whole):
        raise Finding(f"status 0, and half a file: {ran[2][-600:]}")


def undisturbed(command, output):
    judge(run([krs, *command]), {0})
    return len(read(output))


def allocations(r, seed):
    """One allocation fails, or all from one on."""
    shim = compiled("scarce.so", "tests/cli/scarce_malloc.c")
    command, output = job(r)
    whole = undisturbed(command, output)
    descriptor = os.open("count", os.O_CREAT | os.O_RDWR)
    os.dup2(descriptor, 97)
    process = subprocess.run([krs, *command], env={**environment, "LD_PRELOAD": shim, "SCARCE_COUNT": "97"}, pass_fds=[97],
                             stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(97)
    os.close(descriptor)
    made = max(int(line) for line in read("count").split())
    for _ in range(8):
        lasting = {"SCARCE_LASTING": "1"} if r.random() < 0.3 else {}
        at = made - int(made * r.random() ** 2)
        try:
            whole_or_clear(command, output, whole, {0, 1, 69, 70, 71, 73, 74, 75}, LD_PRELOAD=shim, SCARCE_AT=str(at), **lasting)
        except Finding as finding:
            raise Finding(f"allocation {at} {lasting}: {' '.join(command)}: {finding}")
    return 8


def system_calls(r, seed):
    """One system call fails."""
    if not shutil.which("strace"):
        raise Skip("no strace")
    command, output = job(r)
    whole = undisturbed(command, output)
    for _ in range(6):
        call = r.choice(["openat", "read", "pread64", "write", "pwrite64", "fsync", "rename", "close", "mmap", "fstat", "newfstatat",
                         "unlink", "ftruncate", "clone3", "lseek", "mkdir"])
        error = r.choice({"openat": ["EMFILE", "EACCES", "ENOSPC", "EINTR"], "rename": ["EIO", "EACCES"], "mmap": ["ENOMEM"],
                          "clone3": ["EAGAIN"], "fsync": ["EIO", "ENOSPC"]}.get(call, ["EIO", "ENOSPC", "EINTR"]))
        rule = f"{call}:error={error}:when={1 + int(120 * r.random() ** 3)}"
        try:
            # What fails within the dynamic linker ends a program before its first line; lost closes lose nothing.
            whole_or_clear(command, output, whole, PROMISED | {127},
                           ["strace", "-f", "-o", "/dev/null", "-e", f"trace={call}", "-e", f"inject={rule}"])
        except Finding as finding:
            raise Finding(f"{rule}: {' '.join(command)}: {finding}")
    return 6


def vulkan_calls(r, seed):
    """One call of Vulkan fails in a render, or several; a picture that comes is the right one."""
    compiled("vulkan_faults.so", "tests/support/vulkan_faults.c")
    shutil.copy(os.path.join(root, "tests/support/vulkan_faults.json"), tools)
    how = r.choice([[], ["--integrator", "path"], ["--cryptomatte"], ["--noise", "0.1"], ["--light-groups"], ["--rays", "lanes"]])
    rays = [] if "--rays" in how else ["--rays", "kernels"]
    path = write("scene.krs", scene(r, 2))
    command = ["render", path, "--size", "24x16", "--samples", "4", "--quiet", *rays, *how, "-o", "out.exr"]
    log, layer = os.path.abspath("log"), {"VK_LAYER_PATH": tools, "VK_INSTANCE_LAYERS": "VK_LAYER_KRS_faults"}
    for _ in range(2):  # the first one compiles, and makes more calls
        if os.path.exists(log):
            os.unlink(log)
        if judge(run([krs, *command], **layer, KRS_VULKAN_FAULT_LOG=log), {0, 1}):
            raise Skip("refused")
    calls, whole = int(read(log).split()[1]), read("out.exr")
    for _ in range(8):
        fault = f"any:{r.randint(1, calls)}:{r.choice([-4, -4, -2, -1, -3])}:{r.choice([1, 1, 1, 3, 100000])}:{r.choice([1, 1, 60])}"
        os.unlink("out.exr") if os.path.exists("out.exr") else None
        status, _, err = ran = run([krs, *command], **layer, KRS_VULKAN_FAULT=fault)
        try:
            judge(ran, {0, 69, 70, 71}, ["out.exr"])
            if status and err.count("\n") != 1:
                raise Finding(f"more than a line: {err}")
            if status == 0 and read("out.exr") != whole:
                raise Finding("another picture")
        except Finding as finding:
            raise Finding(f"{fault} {' '.join(command)}: {finding}")
    return 8


def kills(r, seed):
    """A render is killed at any time, again and again, and goes on to the same picture."""
    path = write("scene.krs", scene(r, 3))
    command = ["render", path, "--size", "64x48", "--samples", "200", "--quiet", "--rays", "kernels", "--integrator", "path"]
    if judge(run([krs, *command, "-o", "whole.exr"]), {0, 1}):
        raise Skip("refused")
    times = 0
    for _ in range(20):
        process = subprocess.Popen([krs, *command, "--resume", "-o", "part.exr"], env={**environment, "KRS_TEST_CHECKPOINT": "0.05"},
                                   start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(r.uniform(0.05, 1.5) if times < 12 else 120)
            if process.returncode:
                raise Finding(f"status {process.returncode} after {times} kills")
            break
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            times += 1
            if os.path.exists("part.exr") and read("part.exr") != read("whole.exr"):
                raise Finding(f"half a picture after {times} kills")
    if not os.path.exists("part.exr") or read("part.exr") != read("whole.exr"):
        raise Finding(f"another picture after {times} kills")
    return times


def pairs(r, seed):
    """Scenes that mean the same have equal pictures."""
    a, b = shape(r, 2), shape(r, 2)
    one = HEAD + f"show {a} | {b};\n"
    relation = r.choice(["swapped", "named", "commented", "dead", "zero", "function", "threads", "slices", "formatted", "packed"])
    expected = pixels(one)
    if relation == "swapped":
        other = pixels(HEAD + f"show {b} | {a};\n")
    elif relation == "named":
        other = pixels(HEAD + f"let first = {a};\nlet second = {b};\nshow first | second;\n")
    elif relation == "commented":
        other = pixels("// what follows\n" + HEAD.replace("\n", " // camera\n\n") + f"show\n  /* a */ {a}\n  | {b};\n")
    elif relation == "dead":
        other = pixels(HEAD + f"let unused = {shape(r, 2)};\nshow if true then {a} | {b} else sphere(1);\n")
    elif relation == "zero":
        other = pixels(HEAD + f"show ({a} | {b}).move([0, 0, 0] + 0 * [1, 2, 3]);\n")
    elif relation == "function":
        other = pixels(HEAD + f"def both(p, q) = p | q;\nshow both({a}, {b});\n")
    elif relation == "threads":
        other = pixels(one, LP_NUM_THREADS=str(r.randint(1, 5)))
    elif relation == "slices":
        crop = [pixels(one, "--crop", f"0,{y},32,12") for y in (0, 12)]
        other = crop[0] + crop[1]
    elif relation == "formatted":
        judge(run([krs, "format", write("formatted.krs", one)]), {0})
        other = pixels(read("formatted.krs").decode())
    else:
        judge(run([krs, "pack", write("packed.krs", one), "-o", "packed.krsz"]), {0})
        status, other, _ = ran = run([krs, "render", "packed.krsz", "--raw", "--quiet", "--rays", "kernels", "--size", "32x24"])
        judge(ran, {0})
    differ = sum(p != q for p, q in zip(expected, other))
    if len(expected) != len(other) or differ > (30 if relation in ("swapped", "zero", "dead") else 0):
        raise Finding(f"{relation}: {differ} bytes differ:\n{one}")


def validation(r, seed):
    """Renders under all checks of the validation layers."""
    how = r.choice([[], ["--integrator", "path"], ["--cryptomatte"], ["--noise", "0.1"], ["--light-groups"]])
    if not glob.glob("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json"):
        raise Skip("no validation layers")
    checks = ["VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT", "VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT",
              "VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT", "VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT"]
    status, out, err = ran = run([krs, "render", write("scene.krs", scene(r, 3)), "--size", "24x16", "--samples", "3", "--quiet", *how,
                                  "-o", "out.exr"], 900, VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation", VK_LAYER_ENABLES=":".join(checks))
    judge(ran, {0, 1})
    said = [line for line in (out.decode(errors="replace") + err).split("\n") if re.search(r"VUID-|UNASSIGNED-|SYNC-HAZARD", line)]
    said = [line for line in said if not re.search(EXPECTED, line)]
    if said:
        raise Finding("\n".join(said)[:1500])


# What the layers say of themselves, or of advice that is not taken; runtime/device/instance.c hears no more than warnings.
EXPECTED = r"GPU-Assisted|GpuAssisted|features.*enabl|BestPractices-vkCreateDevice|BestPractices-vkAllocateMemory-small|BestPractices-vkBindBufferMemory-small|BestPractices-vkCreateInstance"


def threads(r, seed):
    """Renders, meshes and views under ThreadSanitizer (make build/tsan/krs)."""
    program = os.path.join(build, "tsan/krs")
    if not os.path.exists(program):
        raise Skip("not built")
    path = write("scene.krs", scene(r, 3))
    which = r.randrange(4)
    command = [["render", path, "--size", "24x16", "--quiet", "-o", "out.exr"], ["mesh", path, "--error", "0.2", "--quiet", "-o", "out.stl"],
               ["slice", path, "--layer", "0.3", "--quiet", "-o", "out.svg"], None][which]
    if command is None:
        ran = run([sys.executable, os.path.join(root, "tests/cli/vulkan_faults_view.py"), program, path], 200)
        if "ThreadSanitizer" in ran[1].decode(errors="replace"):
            raise Finding(ran[1].decode(errors="replace")[-1500:])
    else:
        judge(run([program, *command], 300), {0, 1})


# Those that take a minute come seldom.
KINDS = [(language, 4), (grammar, 1), (readers, 40), (language_server, 4), (allocations, 4), (system_calls, 4), (vulkan_calls, 6),
         (kills, 2), (pairs, 12), (validation, 4), (threads, 3), (front_fuzz, 1), (scene_fuzz, 1)]


def one(kind, seed):
    folder = tempfile.mkdtemp(dir=work)
    name, tried = kind.__name__, counts.setdefault(kind.__name__, [0, 0, 0])
    os.chdir(folder)
    try:
        tried[0] += kind(random.Random(f"{name} {seed}"), seed) or 1
    except Skip:
        tried[2] += 1
    except Finding as finding:
        tried[0] += 1
        tried[1] += 1
        failures.append(f"{name} {seed}")
        place = os.path.join(kept, f"{name}-{seed}")
        shutil.copytree(folder, place, dirs_exist_ok=True)
        write(os.path.join(place, "finding.txt"), str(finding))
        print(f"finding: --only {name} --seed {seed} --count 1: {finding}\n{place}", flush=True)
    os.chdir(root)
    shutil.rmtree(folder, ignore_errors=True)


print(f"seed {options.seed}", flush=True)
begun, number = time.time(), 0
end = begun + 3600 * options.hours + options.seconds if options.hours or options.seconds else float("inf")
turns = [kind for kind, times in KINDS for _ in range(times) if not options.only or kind.__name__ in options.only]
random.Random(options.seed).shuffle(turns)
try:
    while number < options.count and time.time() < end:
        one(turns[number % len(turns)], options.seed + number)
        number += 1
except KeyboardInterrupt:
    pass
shutil.rmtree(work, ignore_errors=True)
hours = (time.time() - begun) / 3600
for name, (tried, found, skipped) in sorted(counts.items()):
    print(f"{name}: {tried} executions, {found} findings" + (f", {skipped} left out" if skipped else ""))
if row:
    commit = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    with open(row, "a") as file:
        file.write(f"| {datetime.date.today()} | {commit} | {hours:.2f} | {options.seed} | " +
                   ", ".join(f"{name} {tried:,}" for name, (tried, _, _) in sorted(counts.items())) +
                   f" | {'; '.join(failures) or 'none'} |\n")
print(f"{sum(tried for tried, _, _ in counts.values())} executions in {hours:.2f} hours, {len(failures)} findings")
sys.exit(bool(failures))
