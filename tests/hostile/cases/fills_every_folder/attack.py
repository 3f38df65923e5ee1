# As many bytes and as many files as go, wherever anything can be written.
import contextlib
import os

for folder in ("/", "/tmp", "/dev", "/dev/shm", "/etc", "/submission", "/grader", "/var/tmp", "/work", os.getcwd()):
    written = files = 0
    with contextlib.suppress(OSError), open(f"{folder}/bytes", "wb", buffering=0) as file:
        while written < 1 << 30:
            written += file.write(b"x" * (1 << 20))
    with contextlib.suppress(OSError):
        os.unlink(f"{folder}/bytes")
    with contextlib.suppress(OSError):
        for files in range(100_000):
            os.close(os.open(f"{folder}/{files}", os.O_CREAT | os.O_WRONLY))
    for number in range(files):
        os.unlink(f"{folder}/{number}")
    held = written <= 64 << 20 and files <= 20_000 and (folder in ("/tmp", "/dev/shm", os.getcwd()) or not written + files)
    print("held" if held else "ESCAPED", folder, written, files, flush=True)
