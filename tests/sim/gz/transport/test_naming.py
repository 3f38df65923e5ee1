import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.transport import naming

names = st.text(max_size=30)
valid = st.from_regex(r"[A-Za-z0-9_.]+(/[A-Za-z0-9_.]+){0,3}/?", fullmatch=True)


@pytest.mark.parametrize(
    ("partition", "namespace", "topic", "expected"),
    [
        ("vm:root", "", "/foo", "@/vm:root@/foo"),
        ("vm:root", "ignored", "/foo", "@/vm:root@/foo"),
        ("abc", "robot1", "cmd_vel", "@/abc@/robot1/cmd_vel"),
        ("abc", "/robot1/", "cmd_vel/", "@/abc@/robot1/cmd_vel"),
        ("/abc/", "", "foo", "@/abc@/foo"),
        ("", "", "/foo", "@@/foo"),
    ],
)
def test_fully_qualified_names(partition, namespace, topic, expected):
    assert naming.fully_qualified(partition, namespace, topic) == expected


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("", "must not be empty"),
        ("/", "must not be just '/'"),
        ("a b", "a space"),
        ("a~b", "'~'"),
        ("a@b", "'@'"),
        ("/a//b", "'//'"),
        ("a:=b", "':='"),
        ("x" * 65536, "65535 bytes"),
        ("é" * 32768, "65535 bytes"),
        ("\ud800", "Unicode"),
    ],
)
def test_a_broken_rule_is_quoted(name, rule):
    assert not naming.is_valid_topic(name)
    with pytest.raises(ValueError, match="topic name") as caught:
        naming.fully_qualified("p", "", name)
    assert rule in str(caught.value)


def test_empty_is_a_valid_partition_and_namespace_only():
    assert naming.is_valid_partition("")
    assert naming.is_valid_namespace("")
    assert not naming.is_valid_topic("")


def test_the_whole_name_has_a_limit_too():
    with pytest.raises(ValueError, match="together"):
        naming.fully_qualified("p" * 40000, "", "t" * 40000)


def test_a_bad_name_is_answered_with_a_good_one():
    with pytest.raises(ValueError, match="'/my_topic' would be valid"):
        naming.check("/my topic", "topic")


@given(valid, st.just("") | valid, valid)
def test_split_undoes_qualification(partition, namespace, topic):
    name = naming.fully_qualified(partition, namespace, topic)
    found_partition, found_topic = naming.split(name)
    assert found_partition == partition.removesuffix("/")
    assert found_topic.startswith("/")
    assert found_topic.endswith(topic.removesuffix("/"))
    assert naming.fully_qualified(found_partition, "other", found_topic) == name


@given(names)
def test_what_as_valid_topic_returns_is_valid_or_empty(name):
    result = naming.as_valid_topic(name)
    assert result == "" or naming.is_valid_topic(result)
    if naming.is_valid_topic(name):
        assert result == name


@given(names, names, names)
def test_any_text_is_qualified_or_refused_with_a_sentence(partition, namespace, topic):
    try:
        name = naming.fully_qualified(partition, namespace, topic)
    except ValueError as error:
        assert str(error).endswith(".")
    else:
        assert name.count("@") == 2
        assert naming.split(name)[1].startswith("/")


@given(names)
def test_split_takes_any_text(text):
    try:
        _, topic = naming.split(text)
    except ValueError:
        return
    assert text.startswith("@")
    assert topic
