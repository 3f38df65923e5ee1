"""Returns the entries of a text or of arguments, or raises the ConfigError about them."""

from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
from gz_course.sim.bridge.ros_gz_bridge.config import read_yaml, topics_of
from gz_course.sim.bridge.ros_gz_bridge.finding import raise_errors


def parse_yaml(text, file_name="<string>", **options):
    return topics_of(read_yaml(text, file_name, **options))


def parse_argument(text):
    config = read_arguments([text])
    if not (config.topics or config.services):
        raise_errors(config.findings)
    return (config.topics + config.services)[0]


def parse_arguments(texts):
    config = read_arguments(texts)
    raise_errors(config.findings)
    return config.topics
