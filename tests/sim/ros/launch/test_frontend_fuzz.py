"""Damaged and hostile launch files in XML and YAML: a launch description, or one sentence with the file's name."""

import random

import pytest

from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.ros.launch_xml import Parser as XMLParser
from gz_course.sim.ros.launch_yaml import Parser as YAMLParser
from gz_course.tests.sim.ros.launch.test_frontend import XML, YAML

NODES = """\
<launch><push_ros_namespace namespace="r"/><set_parameter name="g" value="1.5"/><set_remap from="p" to="q"/>
<node pkg="p" exec="e" name="a" args="x 'y z'" ros_args="-p a:=1" output="screen" respawn="true" respawn_delay="1.5">
<param name="n" value="5"/><param name="l" value="1,2" value-sep="," type="int[]"/><param from="f" allow_substs="true"/>
<param name="w"><param name="r" value="0.5"/></param><remap from="/a" to="/b"/><env name="A" value="b"/></node>
<lifecycle_node pkg="p" exec="e" name="n" autostart="true"/><ros_timer period="0.5"><shutdown reason="r"/></ros_timer>
<node_container pkg="p" exec="e" name="c" namespace=""><composable_node pkg="p" plugin="q">
<extra_arg name="a" value="b"/></composable_node></node_container>
<include file="$(find-pkg-share p)/f"><arg name="a" value="b"/></include></launch>
"""
BITS = [
    *("$(", ")", "$(var x)", "$(eval '", "'", '"', "\\", "$(command", "$(", "&lt;", "&x;", "]]>", "<!--", "<![CDATA["),
    *("<launch>", "</launch>", "<node", "/>", ">", "<", "=", ' if="', "true", "1", "nan", "1e999", "-", "\0", "\ud7ff"),
    *(
        "[",
        "]",
        "{",
        "}",
        ": ",
        "- ",
        "\n",
        "  ",
        "&a ",
        "*a",
        "!!python/object:os.system x",
        "!!binary x",
        "<<: ",
        "? ",
    ),
    *(
        "2026-13-45",
        "0x",
        "~",
        "null",
        "launch:",
        "%YAML 9.9\n",
        "---\n",
        "...",
        "\t",
        "é",
        "\u2028",
        "a" * 300,
        "name",
    ),
]
HOSTILE = [
    "<launch>" * 5000,
    "<launch>" + "<group>" * 150 + "</group>" * 150 + "</launch>",
    '<!DOCTYPE a [<!ENTITY b "'
    + "x" * 1000
    + '"><!ENTITY c "'
    + "&b;" * 100
    + '">]><launch><log message="&c;"/></launch>',
    '<!DOCTYPE a [<!ENTITY f SYSTEM "file:///etc/passwd">]><launch><log message="a"/>&f;</launch>',
    '<launch><log message="' + "$(var " * 2000 + '"/></launch>',
    "launch: &a [*a]",
    "launch: &a\n- group: *a\n",
    "launch: " + "[" * 3000,
    "a: &a [x, x]\nb: &b [*a, *a]\nlaunch: [*b, *b]",
    "&a launch: [{*a : *a}]",
    "x: &x {log: {message: a}}\n",
    "launch:\n"
    + "".join(f"- group: &g{n} [{'*g' + str(n - 1) + ', ' if n else ''}{{log: {{message: a}}}}]\n" for n in range(20)),
]


def damaged(seed, numbers):
    text = list(seed)
    for _ in range(numbers.randint(1, 4)):
        at = numbers.randrange(len(text) + 1)
        match numbers.randrange(4):
            case 0:
                del text[at : at + numbers.choice((1, 2, 10, 60))]
            case 1:
                text[at:at] = numbers.choice(BITS)
            case 2:
                text[at : at + numbers.randint(1, 8)] = numbers.choice(BITS)
            case 3:
                other = numbers.randrange(len(text) + 1)
                text[at:at] = text[other : other + numbers.randint(1, 80)]
    return "".join(text)


def check(parser, name, text):
    """Return whether a text is a launch description; a refusal is one sentence."""
    try:
        root, used = parser.load_text(text, name)
        used.parse_description(root)
    except InvalidLaunchFileError as error:
        sentence = str(error)
        assert sentence.startswith(name) and len(sentence.splitlines()) == 1 and "Traceback" not in sentence, (
            text,
            sentence,
        )
        return False
    return True


def walk(cases, numbers):
    seeds = ((XMLParser, "a.launch.xml", XML), (XMLParser, "a.launch.xml", NODES), (YAMLParser, "a.launch.yaml", YAML))
    fine = 0
    for case in range(cases):
        parser, name, seed = seeds[case % len(seeds)]
        fine += check(parser, name, damaged(seed, numbers))
    return fine


def test_damaged_files():
    assert check(XMLParser, "a.launch.xml", NODES)
    walk(100, random.Random(1))


def test_hostile_files():
    for text in HOSTILE:
        parser, name = (XMLParser, "a.launch.xml") if text.startswith("<") else (YAMLParser, "a.launch.yaml")
        check(parser, name, text)


@pytest.mark.proof
def test_fifty_thousand_damaged_files():
    assert 500 < walk(50_000, random.Random(2)) < 40_000
