"""A callback that awaits a future is at rest until the future is done, whoever sets it."""

NODE = """
import threading
import time
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

said = node.create_publisher(String, "/said", 10)

def say(text):
    said.publish(String(data=f"{text} {node.get_clock().now().nanoseconds / 1e9:.1f}"))

by_timer, by_thread = Future(), Future()

async def first():
    timer.cancel()
    say("begins")
    say(await by_timer)
    say(await nested())

async def nested():
    return await by_thread

def work():
    time.sleep(0.85)
    by_thread.set_result("thread")

threading.Thread(target=work, daemon=True).start()
timer = node.create_timer(0.2, first, callback_group=ReentrantCallbackGroup())  # else it keeps all others from running
node.create_timer(0.5, lambda: by_timer.set_result("timer"))
rclpy.spin(node)
"""


def test_who_awaits_is_in_step(play):
    played = play(ticks=14, holding=False, simulated=True, node=NODE)
    assert played.pace.paced_ticks == 0, played.lines
    names, times = zip(*(line.split() for line in played.heard), strict=True)
    assert names == ("begins", "timer", "thread"), played.heard
    assert 0.0 < float(times[0]) < float(times[1]) < float(times[2]) < 1.3, played.heard
