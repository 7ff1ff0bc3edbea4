"""storm.py: random messages to `krs lsp`, of which many are broken.

    python3 storm.py KRS EXAMPLES [SESSIONS]

Each session opens examples, edits them at random, and asks at random places; bytes, values and whole messages are broken
on the way.  A session must end in time, by itself, with status 0 or 1, and all that comes back must be messages.
"""
import json
import os
import random
import subprocess
import sys

METHODS = ["documentSymbol", "definition", "references", "documentHighlight", "prepareRename", "rename", "hover", "completion",
           "signatureHelp", "semanticTokens/full", "semanticTokens/range", "foldingRange", "selectionRange", "documentColor",
           "colorPresentation", "documentLink", "codeAction", "formatting", "nothing"]
PIECES = ["(", ")", "[", "]", "{", "}", "let ", "def f(x) = ", "krs { ", "\"", "/*", "*/", "//", ";", ",", ".", ":", "#", "#ff00",
          "1e999", "30deg", "if ", " then ", " else ", "for i in 0..9 ", "use \"std/trees.krs\";", "\n", "\r\n", "\u00e9", "\U0001F30D",
          "sphere(1)", ".move([1, 0, 0])", "camera { ", "shape s(r = 1) { distance: ", "print(", "x", "\t"]


def position(random):
    return {"line": random.choice([0, 1, random.randrange(80), random.randrange(-9, 1 << 40)]),
            "character": random.choice([0, random.randrange(90), random.randrange(-9, 1 << 40)])}


def span(random):
    return {"start": position(random), "end": position(random)}


def messages(random, texts):
    yield {"jsonrpc": "2.0", "id": 0, "method": "initialize", "params": {"capabilities": {}}}
    uris = ["untitled:%d.krs" % i for i in range(3)]
    for uri in uris:
        yield {"jsonrpc": "2.0", "method": "textDocument/didOpen",
               "params": {"textDocument": {"uri": uri, "languageId": "krs", "version": 1, "text": random.choice(texts)}}}
    for number in range(1, 60):
        document = {"uri": random.choice(uris), "version": number}
        if random.random() < 0.4:
            changes = [{"range": span(random), "text": random.choice(PIECES)} for _ in range(random.randrange(4))]
            yield {"jsonrpc": "2.0", "method": "textDocument/didChange",
                   "params": {"textDocument": document, "contentChanges": changes}}
        else:
            yield {"jsonrpc": "2.0", "id": number, "method": "textDocument/" + random.choice(METHODS),
                   "params": {"textDocument": document, "position": position(random), "range": span(random),
                              "positions": [position(random)] if random.random() < 0.2 else None,
                              "newName": random.choice(["a", "let", "", "x y", "size"]), "color": {"red": random.uniform(-1, 2)},
                              "context": {"diagnostics": [{"range": span(random), "data": {"replacement": "a"}}]}}}
    yield {"jsonrpc": "2.0", "id": 99, "method": "shutdown"}
    yield {"jsonrpc": "2.0", "method": "exit"}


def break_value(random, value):
    """The same with one part of another type."""
    if isinstance(value, dict) and value and random.random() < 0.8:
        key = random.choice(list(value))
        return {**value, key: break_value(random, value[key])}
    if isinstance(value, list) and value and random.random() < 0.8:
        index = random.randrange(len(value))
        return value[:index] + [break_value(random, value[index])] + value[index + 1:]
    return random.choice([None, True, -1, 1e300, "", "\x00", [], {}, [[[]]], {"uri": 7}])


def frame(random, message, wild):
    if wild and random.random() < 0.1:
        message = break_value(random, message)
    body = bytearray(json.dumps(message).encode())
    if wild and random.random() < 0.05:
        body[random.randrange(len(body))] = random.randrange(256)
    length = len(body) if not wild or random.random() > 0.001 else random.choice([0, 5, len(body) + 9])
    return b"Content-Length: %d\r\n\r\n" % length + bytes(body)


def answers(out):
    """The messages of a stream; an error where it is none."""
    while out:
        header, _, rest = out.partition(b"\r\n\r\n")
        length = int(header.split(b":")[1])
        if len(rest) < length:
            raise ValueError("a message is cut")
        yield json.loads(rest[:length])
        out = rest[length:]


def main():
    krs, folder, sessions = sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 12
    texts = [open(os.path.join(folder, name), encoding="utf-8").read() for name in sorted(os.listdir(folder)) if name.endswith(".krs")]
    count = 0
    for seed in range(sessions):
        chance = random.Random(seed)
        wild = seed % 3 > 0
        sent = b"".join(frame(chance, message, wild) for message in messages(chance, texts))
        done = subprocess.run([krs, "lsp"], input=sent, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300)
        try:
            got = list(answers(done.stdout))
        except ValueError as error:
            sys.exit("session %d: %s" % (seed, error))
        if done.returncode not in (0, 1) or (not wild and done.returncode):
            sys.exit("session %d ends with %d: %s" % (seed, done.returncode, done.stderr.decode(errors="replace")[-500:]))
        asked = {number for number in range(1, 60)} if not wild else set()
        if not wild and len([a for a in got if a.get("id") in asked]) < 20:
            sys.exit("session %d has few answers" % seed)
        count += len(got)
    print("%d sessions, %d answers" % (sessions, count))


main()
