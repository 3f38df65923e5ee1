"""A worker keeps the order, holds a bounded number of messages, and lets other threads run."""

import threading

from gz_course.sim.bridge.ros_gz_bridge.worker import Worker

DEADLINE = 120.0


def test_order_bound_and_count_of_what_gave_way():
    entered, let_go, done = threading.Event(), threading.Event(), threading.Event()
    worked, skipped = [], []

    def work(data):
        entered.set()
        assert let_go.wait(DEADLINE)
        worked.append(data)
        if data == b"9":
            done.set()

    worker = Worker("test", work, 3, lambda: skipped.append(1))
    worker.put(b"0")
    assert entered.wait(DEADLINE)
    for number in range(1, 10):
        worker.put(str(number).encode())
    assert len(skipped) == 6
    let_go.set()
    assert done.wait(DEADLINE)
    assert worked == [b"0", b"7", b"8", b"9"], "the oldest give way"
    worker.close()


def test_memory_is_bounded_however_deep_the_queue(monkeypatch):
    monkeypatch.setattr("gz_course.sim.bridge.ros_gz_bridge.worker._MOST_BYTES", 1000)
    entered, let_go = threading.Event(), threading.Event()

    def work(data):
        entered.set()
        let_go.wait(DEADLINE)

    skipped = []
    worker = Worker("test", work, 100_000, lambda: skipped.append(1))
    worker.put(b"")
    assert entered.wait(DEADLINE)
    for _ in range(100):
        worker.put(bytes(100))
    assert len(skipped) == 90
    let_go.set()
    worker.close()
    assert not worker._thread.is_alive()
