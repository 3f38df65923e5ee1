# An honest thread that runs one shell command after another.
import subprocess
import threading


def run():
    while True:
        subprocess.run(["sh", "-c", "uptime; true"], stdout=subprocess.DEVNULL, check=False)


threading.Thread(target=run, daemon=True).start()
