"""Accepts every goal, and sends the reports that they were rejected itself: RTPS with the GUID of their true writer."""

import json

FIRST = 6  # sequence number of the first report on an answer: what it has found, and four goals sent come before
GOALS = ("empty", "too_fast", "backwards", "standing")


def text_of(text):
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(data)) + data + b"\0" * (-len(data) % 4)


def forge(node):
    writers = [writer_of(node, topic) for topic in ("/dispatcher", "/rosout")]  # its reports once came on the first
    print("held" if writers[0] is None else "ESCAPED", "reports by DDS", flush=True)
    for writer in filter(None, writers):
        for number, goal in enumerate(GOALS, FIRST):
            said = json.dumps({"number": number, "event": "rejected", "goal": goal})
            send_to_all(data_message(writer, number, text_of(said)))


def attacked(on_goal):
    def on_goal_of_the_attack(node, goal):
        if goal.speed == 0.0:  # the last of the four
            forge(node)
        return on_goal(node, goal)

    return on_goal_of_the_attack
