"""What the options of `ros2 pkg create` say of a package, its package.xml, and the list of its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape, quoteattr

from gz_course.sim.ros.ros2.new_package import ament_python, cmake, license_texts

BUILD_TYPES = ("cmake", "ament_cmake", "ament_python")
_GENERATORS = "rosidl_default_generators"


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
    library: str = ""
    format: int = 3

    @property
    def for_interfaces(self) -> bool:
        """Whether the package is for messages, services and actions of one's own."""
        return self.build_type == "ament_cmake" and _GENERATORS in self.dependencies

    def files(self) -> dict[str, str]:
        """Return the content of each file by its path in the folder of the package."""
        made = {"package.xml": self._manifest()}
        if self.build_type == "ament_python":
            made |= ament_python.files(
                self.name,
                maintainer=self.maintainer,
                email=self.email,
                description=self.description,
                license_name=self.license,
                node=self.node,
                library=self.library,
            )
        else:
            made |= cmake.files(
                self.name,
                self.dependencies,
                ament=self.build_type == "ament_cmake",
                interfaces=self.for_interfaces,
                node=self.node,
                library=self.library,
            )
        if text := license_texts.text(self.license, self.maintainer):
            made["LICENSE"] = text
        return made

    def folders(self) -> list[str]:
        """Return the folders that a package has even without a file in them."""
        return [] if self.build_type == "ament_python" else ["src", f"include/{self.name}"]

    def _manifest(self) -> str:
        lines = [f"  <{tag}>{escape(name)}</{tag}>" for tag, name in self._needs()]
        if self.for_interfaces:
            lines += ["", "  <member_of_group>rosidl_interface_packages</member_of_group>"]
        return (
            '<?xml version="1.0"?>\n'
            f'<?xml-model href="http://download.ros.org/schema/package_format{self.format}.xsd" '
            'schematypens="http://www.w3.org/2001/XMLSchema"?>\n'
            f'<package format="{self.format}">\n'
            f"  <name>{self.name}</name>\n"
            "  <version>0.0.0</version>\n"
            f"  <description>{escape(self.description)}</description>\n"
            f"  <maintainer email={quoteattr(self.email)}>{escape(self.maintainer)}</maintainer>\n"
            f"  <license>{escape(self.license)}</license>\n"
            "\n" + "".join(f"{line}\n" for line in lines) + ("\n" if lines else "") + "  <export>\n"
            f"    <build_type>{self.build_type}</build_type>\n"
            "  </export>\n"
            "</package>\n"
        )

    def _needs(self) -> list[tuple[str, str]]:
        """Return the tag and the package of each dependency."""
        needs = []
        if self.build_type == "ament_cmake":
            needs.append(("buildtool_depend", "ament_cmake_ros" if self.library else "ament_cmake"))
        for name in self.dependencies:
            if self.for_interfaces and name == _GENERATORS:
                needs += [("buildtool_depend", name), ("exec_depend", "rosidl_default_runtime")]
            else:
                needs.append(("depend", name))
        if self.build_type == "ament_python" and self.node:
            started = [name for name in ("launch", "launch_ros") if name not in self.dependencies]
            needs += [("exec_depend", name) for name in started]
        tests = {"ament_cmake": ["ament_lint_auto", "ament_lint_common"], "ament_python": ["python3-pytest"]}
        needs += [("test_depend", name) for name in tests.get(self.build_type, [])]
        return needs
