"""The connection to a process of the submission: nothing that it waits for is lost."""

import json
import socket

from gz_course.grader.run.processes.participant import MOST_ANSWERS, MOST_UNSENT, Participant

MANY = 5_000  # orders; a socket holds some hundreds


def connected():
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    theirs.settimeout(60.0)

    def answer(who, message):
        who.tell({"answer": message["time"]})

    return Participant(ours, 0, answer), theirs


def answers(participant, theirs, wanted):
    """Return the first answers that a process gets which reads until it has so many."""
    found = []
    while len(found) < wanted:
        message = json.loads(theirs.recv(1 << 16))
        found += [message["answer"]] if "answer" in message else []
        participant.read()
    return found


def test_orders_that_nobody_reads_take_no_answer_its_place():
    """`ros2 run` reads only while it asks; what it was ordered to meanwhile had filled the socket."""
    participant, theirs = connected()
    with theirs:
        for _ in range(MANY):
            participant.tell({"look": True})
        theirs.send(json.dumps({"time": 1}).encode())
        participant.read()
        assert answers(participant, theirs, 1) == [1]
        participant.close()


def test_what_is_kept_for_a_process_that_never_reads_is_bounded():
    participant, theirs = connected()
    with theirs:
        for number in range(MANY):
            participant.tell({"now": number})
        assert len(participant._unsent) <= MOST_UNSENT
        theirs.send(json.dumps({"time": 2}).encode())
        participant.read()
        assert answers(participant, theirs, 1) == [2]
        participant.close()


def test_orders_come_in_their_order():
    participant, theirs = connected()
    with theirs:
        for number in range(MOST_UNSENT):
            participant.tell({"now": number})
        read = []
        while len(read) < MOST_UNSENT:
            read.append(json.loads(theirs.recv(1 << 16))["now"])
            participant.read()
        assert read == list(range(MOST_UNSENT))
        participant.close()


def test_who_asks_and_never_reads_does_not_fill_the_memory():
    participant, theirs = connected()
    with theirs:
        for number in range(MANY):
            theirs.send(json.dumps({"time": number}).encode())
            participant.read()
        assert len(participant._unsent) <= MOST_UNSENT + MOST_ANSWERS
        participant.close()
