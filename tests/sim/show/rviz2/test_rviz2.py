"""Live topics over DDS in a file, the viewer as a process that only this machine reaches, and the sentences."""

import http.client
import signal
import threading
import time
import urllib.parse
import urllib.request

import psutil
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from gz_course.sim.show.rviz2.canvas import Canvas
from gz_course.sim.show.rviz2.inline import Frame, watch_frame
from gz_course.sim.show.rviz2.subscriber import Subscriber
from gz_course.sim.show.rviz2.viewer import FileServer, Viewer

MODULE = "gz_course.sim.show.rviz2.rviz2"
DEADLINE_S = 120.0


def entities(path):
    return {chunk.entity_path for chunk in RrdReader(path).stream()}


def test_topics_are_drawn_as_they_come_whatever_their_qos(ros_node, spin_until, tmp_path):
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
    from sensor_msgs.msg import LaserScan
    from std_msgs.msg import Float32, String

    stream = rr.RecordingStream("test", send_properties=False)
    stream.save(tmp_path / "live.rrd")
    said, changes = [], []
    subscriber = Subscriber(ros_node, Canvas(stream, said.append), ["scan", "/v*", "/said"], lambda: changes.append(1))
    subscriber.look()
    assert subscriber.missing() == ["/scan", "/v*", "/said"]
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    scan = ros_node.create_publisher(LaserScan, "/scan", best_effort)
    value = ros_node.create_publisher(Float32, "/value", 1)
    ros_node.create_publisher(String, "/said", latched).publish(String(data="once"))
    ros_node.create_publisher(Float32, "/other", 1)

    def rounds():
        subscriber.look()
        scan.publish(LaserScan(ranges=[1.0]))
        value.publish(Float32(data=2.0))
        return {"/scan", "/value", "/said"} <= set(subscriber.counts)

    spin_until(rounds, "all three")
    # A publisher that offers less comes: the topic is subscribed to again.
    other = ros_node.create_publisher(Float32, "/value", best_effort)
    before = subscriber._subscriptions["/value"]
    spin_until(lambda: subscriber.look() or subscriber._subscriptions["/value"] != before, "the new subscription")
    count = subscriber.counts["/value"]
    spin_until(lambda: other.publish(Float32(data=3.0)) or subscriber.counts["/value"] > count, "its messages")
    stream.disconnect()
    assert subscriber.missing() == [] and len(changes) >= 3 and not said
    assert {"/topics/scan", "/plots/value/data", "/log/topics/said"} <= entities(tmp_path / "live.rrd")
    assert not any("other" in each for each in entities(tmp_path / "live.rrd"))


def test_a_message_that_makes_no_sense_is_passed_over(ros_node, spin_until, tmp_path):
    from sensor_msgs.msg import PointCloud2, PointField

    stream = rr.RecordingStream("test", send_properties=False)
    stream.save(tmp_path / "live.rrd")
    said = []
    subscriber = Subscriber(ros_node, Canvas(stream, said.append))
    fields = [PointField(name=name, datatype=7, count=1) for name in "xyz"]
    subscriber._taker("/c", ["sensor_msgs/msg/PointCloud2"][0])(
        PointCloud2(fields=fields, width=9, height=9, point_step=3)
    )
    stream.disconnect()
    assert len(said) == 1 and said[0].startswith("a message on /c cannot be drawn: ")


def test_the_program_writes_what_it_hears_until_ctrl_c(call, programs, ros_node):
    from geometry_msgs.msg import Twist

    publisher = ros_node.create_publisher(Twist, "/cmd_vel", 1)
    path = programs.folder / "live.rrd"
    over = threading.Event()

    def publish_and_interrupt():
        end = time.monotonic() + DEADLINE_S
        while publisher.get_subscription_count() == 0 and time.monotonic() < end:
            over.wait(0.02)
        publisher.publish(Twist())
        publisher.wait_for_all_acked()
        signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

    thread = threading.Thread(target=publish_and_interrupt)
    thread.start()
    code, said = call(MODULE, "--save", str(path), "-d", "my.rviz")
    thread.join(DEADLINE_S)
    assert code == 0 and "my.rviz is not read" in said and f"writing {path}; Ctrl-C ends it" in said


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--save", "nowhere/a.rrd"], "give the name of a file that ends with .rrd, in a folder that exists"),
        (["--colour"], "unrecognized arguments: --colour"),
    ],
)
def test_words_that_cannot_be_used(call, words, sentence):
    code, said = call(MODULE, *words)
    assert code == 2 and sentence in said


def test_the_page_is_of_this_machine_only_and_ends_with_the_viewer(tmp_path):
    (tmp_path / "a run.rrd").write_bytes(b"RRF2 and more")
    with Viewer(web=True) as viewer, FileServer(tmp_path / "a run.rrd") as server:
        child = psutil.Process(viewer._process.pid)
        page = viewer.address_of(server.url)
        with urllib.request.urlopen(page, timeout=DEADLINE_S) as answer:
            assert b"Rerun" in answer.read()
        asked = urllib.parse.parse_qs(urllib.parse.urlsplit(page).query)["url"][0]
        with urllib.request.urlopen(asked, timeout=DEADLINE_S) as answer:
            assert answer.read() == b"RRF2 and more"
        connection = http.client.HTTPConnection(urllib.parse.urlsplit(asked).netloc, timeout=DEADLINE_S)
        connection.request("GET", "/a%20run.rrd")
        assert connection.getresponse().status == 404, "without the token"
        connection.close()
        listening = {c.laddr.ip for c in child.net_connections() if c.status == psutil.CONN_LISTEN}
        assert listening == {"127.0.0.1"}
    assert not child.is_running() and not viewer.is_running


def test_a_frame_holds_page_words_and_picture(monkeypatch):
    frame = Frame("http://127.0.0.1:1/?url=a&b", 'the "run"', b"PNG")
    text = frame._repr_html_()
    assert 'src="http://127.0.0.1:1/?url=a&amp;b"' in text and 'alt="the &quot;run&quot;"' in text
    assert repr(frame) == 'the "run": http://127.0.0.1:1/?url=a&b'
    monkeypatch.setenv("COURSE_PROXY", "/")  # the browser is on another machine
    text = frame._repr_html_()
    assert "<iframe" not in text and "<img" in text and "browser on the machine" in text
    started = []

    class Program:
        def wait_for(self, text):
            return f"open this page in a browser: http://127.0.0.1:2/?url=x\n{text}\n"

    live = watch_frame(lambda *words: started.append(words) or Program(), "/scan", plot=["/odom/x y"])
    assert live.address == "http://127.0.0.1:2/?url=x" and live.words == "Live, what ROS says: /scan"
    assert started == [("course watch --web --no-browser '--plot=/odom/x y' /scan", "course watch")]
