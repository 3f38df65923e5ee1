"""The files of a new ROS package, as `ros2 pkg create` makes them.

Source: ros2pkg 0.32 (`resource/`: which files a package of each build type has); their content is the course's own
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape, quoteattr

BUILD_TYPES = ("cmake", "ament_cmake", "ament_python")


@dataclass(frozen=True)
class NewPackage:
    """What the options of `ros2 pkg create` say of a package."""

    name: str
    build_type: str
    description: str
    license: str
    maintainer: str
    email: str
    dependencies: Sequence[str] = ()
    node: str = ""

    def files(self) -> dict[str, str]:
        """Return the content of each file by its path in the folder of the package."""
        made = {"package.xml": self._manifest()}
        if self.build_type == "ament_python":
            made |= {f"resource/{self.name}": "", f"{self.name}/__init__.py": ""}
            made |= {"setup.cfg": self._setup_cfg(), "setup.py": self._setup()}
            if self.node:
                made[f"{self.name}/{self.node}.py"] = _PYTHON_NODE.format(self.name)
            return made
        made["CMakeLists.txt"] = self._cmake_lists()
        if self.node:
            made[f"src/{self.node}.cpp"] = _CPP_NODE.format(self.name)
        return made

    def _manifest(self) -> str:
        tool = (
            "" if self.build_type == "ament_python" else f"  <buildtool_depend>{self.build_type}</buildtool_depend>\n"
        )
        needs = "".join(f"  <depend>{escape(each)}</depend>\n" for each in self.dependencies)
        return (
            '<?xml version="1.0"?>\n'
            '<?xml-model href="http://download.ros.org/schema/package_format3.xsd" '
            'schematypens="http://www.w3.org/2001/XMLSchema"?>\n'
            '<package format="3">\n'
            f"  <name>{self.name}</name>\n"
            "  <version>0.0.0</version>\n"
            f"  <description>{escape(self.description)}</description>\n"
            f"  <maintainer email={quoteattr(self.email)}>{escape(self.maintainer)}</maintainer>\n"
            f"  <license>{escape(self.license)}</license>\n"
            f"\n{tool}{needs}\n"
            "  <export>\n"
            f"    <build_type>{self.build_type}</build_type>\n"
            "  </export>\n"
            "</package>\n"
        )

    def _cmake_lists(self) -> str:
        ament = self.build_type == "ament_cmake"
        found = [*(["ament_cmake"] if ament else []), *self.dependencies]
        lines = ["cmake_minimum_required(VERSION 3.8)", f"project({self.name})", ""]
        lines += [f"find_package({each} REQUIRED)" for each in found]
        if self.node:
            lines += ["", f"add_executable({self.node} src/{self.node}.cpp)"]
            if ament and self.dependencies:
                lines.append(f"ament_target_dependencies({self.node} {' '.join(self.dependencies)})")
            lines.append(f"install(TARGETS {self.node} DESTINATION lib/${{PROJECT_NAME}})")
        return "\n".join([*lines, *(["", "ament_package()"] if ament else []), ""])

    def _setup_cfg(self) -> str:
        place = f"$base/lib/{self.name}"
        return f"[develop]\nscript_dir={place}\n[install]\ninstall_scripts={place}\n"

    def _setup(self) -> str:
        start = f"            '{self.node} = {self.name}.{self.node}:main',\n" if self.node else ""
        return _SETUP.format(
            name=self.name,
            maintainer=self.maintainer,
            email=self.email,
            description=self.description,
            license=self.license,
            start=start,
        )


_PYTHON_NODE = """\
def main():
    print('Hi from {}.')


if __name__ == '__main__':
    main()
"""
_CPP_NODE = """\
#include <cstdio>

int main()
{{
  std::printf("hello world {} package\\n");
  return 0;
}}
"""
_SETUP = """\
from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={maintainer!r},
    maintainer_email={email!r},
    description={description!r},
    license={license!r},
    entry_points={{
        'console_scripts': [
{start}        ],
    }},
)
"""
