"""The files of a package of build type `ament_python`: a module, and with a node its launch file and its test."""

from __future__ import annotations


def files(
    name: str, *, maintainer: str, email: str, description: str, license_name: str, node: str, library: str
) -> dict[str, str]:
    """Return the content of each file by its path."""
    place = f"$base/lib/{name}"
    made = {
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
        "setup.cfg": f"[develop]\nscript_dir={place}\n[install]\ninstall_scripts={place}\n",
        "setup.py": _SETUP.format(
            imports=_GLOB if node else "",
            name=name,
            launch=_LAUNCH_FILES if node else "",
            maintainer=maintainer,
            email=email,
            description=description,
            license=license_name,
            start=f"            '{node} = {name}.{node}:main',\n" if node else "",
        ),
        "test/test_package.py": _TEST_PACKAGE.format(name=name),
    }
    if library:
        made[f"{name}/{library}/__init__.py"] = ""
    if node:
        made[f"{name}/{node}.py"] = _NODE.format(name)
        made[f"launch/{node}.launch.py"] = _LAUNCH.format(name=name, node=node)
        made[f"test/test_{node}.py"] = _TEST_NODE.format(name=name, node=node)
    return made


_NODE = """\
def main():
    print('Hi from {}.')


if __name__ == '__main__':
    main()
"""
_LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='{name}', executable='{node}', output='screen'),
    ])
"""
_TEST_PACKAGE = """\
from pathlib import Path
from xml.etree import ElementTree

import {name}


def test_the_manifest_has_the_name_of_the_module():
    manifest = ElementTree.parse(Path(__file__).parents[1] / 'package.xml').getroot()
    assert manifest.findtext('name') == {name}.__name__
"""
_TEST_NODE = """\
from {name}.{node} import main


def test_the_node_says_hello(capsys):
    main()
    assert capsys.readouterr().out == 'Hi from {name}.\\n'
"""
_GLOB = "from glob import glob\n\n"
_LAUNCH_FILES = "        ('share/' + package_name + '/launch', glob('launch/*')),\n"
_SETUP = """\
{imports}from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
{launch}    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={maintainer!r},
    maintainer_email={email!r},
    description={description!r},
    license={license!r},
    extras_require={{
        'test': ['pytest'],
    }},
    entry_points={{
        'console_scripts': [
{start}        ],
    }},
)
"""
