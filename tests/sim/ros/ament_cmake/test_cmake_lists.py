"""What a CMakeLists.txt says about a package."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.ament_cmake.cmake_lists import read_cmake_lists
from gz_course.sim.ros.ament_cmake.errors import PackageError

FRAME = """\
cmake_minimum_required(VERSION 3.8)
project(robot_msgs)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package(std_msgs REQUIRED)
{}
ament_package()
"""


@pytest.fixture
def read(tmp_path):
    def read(body, frame=FRAME):
        path = tmp_path / "CMakeLists.txt"
        path.write_text(frame.format(body))
        return read_cmake_lists(path)

    return read


FORMS = [
    'rosidl_generate_interfaces(${PROJECT_NAME} "msg/A.msg" "srv/B.srv" DEPENDENCIES std_msgs)',
    "set(msg_files msg/A.msg)\nset(srv_files\n  srv/B.srv\n)\n"
    "rosidl_generate_interfaces(${PROJECT_NAME} ${msg_files} ${srv_files} DEPENDENCIES std_msgs)",
    "list(APPEND FILES msg/A.msg srv/B.srv) # all\nset(DEPS std_msgs)\n"
    "rosidl_generate_interfaces(robot_msgs ${FILES} DEPENDENCIES ${DEPS} ADD_LINTER_TESTS)",
    'file(GLOB FILES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS "msg/*.msg" "srv/*.srv")\n'
    "rosidl_generate_interfaces(${PROJECT_NAME} ${FILES} DEPENDENCIES std_msgs)",
    "rosidl_generate_interfaces(${PROJECT_NAME} msg/A.msg DEPENDENCIES std_msgs)\n"
    "rosidl_generate_interfaces(${PROJECT_NAME}_more srv/B.srv DEPENDENCIES std_msgs)",
    "if(std_msgs_FOUND AND NOT WIN32)\n  set(F msg/A.msg srv/B.srv)\nelse()\n  message(FATAL_ERROR no)\nendif()\n"
    "rosidl_generate_interfaces(${PROJECT_NAME} ${F} DEPENDENCIES std_msgs)",
]


@pytest.mark.parametrize("body", FORMS)
def test_interfaces_in_the_forms_of_the_tutorials(read, tmp_path, body):
    for name in ("msg/A.msg", "srv/B.srv"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    lists = read(body)
    assert (lists.project, list(lists.interfaces), list(lists.dependencies)) == (
        "robot_msgs",
        ["msg/A.msg", "srv/B.srv"],
        ["std_msgs"],
    )
    assert lists.remarks == []


QUIET = """\
if(NOT CMAKE_CXX_STANDARD)
  set(CMAKE_CXX_STANDARD 17)
endif()
if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall)
endif()
ament_export_dependencies(rosidl_default_runtime)
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  if(A)
    anything(at all)
  endif()
endif()
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME}/)
"""


def test_what_every_package_has_gets_no_remark(read):
    lists = read(QUIET)
    assert lists.remarks == []
    assert [(each.source, each.destination) for each in lists.files] == [
        ("launch", "share/robot_msgs"),
        ("config", "share/robot_msgs"),
    ]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("add_executable(talker src/talker.cpp)", "add_executable() 'talker' is not built: that needs a compiler"),
        ("configure_file(a b)", "'configure_file()' is passed over: without an installed ament_cmake"),
        ("foreach(a RANGE 3)\n  set(${a} 1)\nendforeach()", "this form of 'foreach()' is ignored"),
        ("while(a)\n  set(${a} 1)\nendwhile()", "what stands in 'while()' is passed over"),
        ("if(A SOMEHOW B)\nendif()", "the condition of 'if()' is not understood at 'SOMEHOW'"),
        ('message(WARNING "mind the gap")', "mind the gap"),
        ("install(SCRIPT x.cmake)", "'install(SCRIPT ...)' is passed over: only DIRECTORY, FILES and PROGRAMS"),
    ],
)
def test_anything_else_gets_a_sentence_with_file_and_line(read, body, words):
    (remark,) = read(body).remarks
    assert "CMakeLists.txt:6: " in remark
    assert words in remark


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "rosidl_generate_interface(x y)",
            "6: Unknown CMake command 'rosidl_generate_interface'; did you mean 'rosidl",
        ),
        (
            "rosidl_generate_interfaces(robot_msgs)",
            "6: rosidl_generate_interfaces() called without any interface files",
        ),
        ("rosidl_generate_interfaces(msg/A.msg)", "6: expected ${PROJECT_NAME} as the first argument"),
        (
            "rosidl_generate_interfaces(robot_msgs msg/A.msg DEPENDENCIES geometry_msgs)",
            "6: rosidl_generate_interfaces() the passed dependency 'geometry_msgs' has not been found before using "
            "find_package(); write find_package(geometry_msgs REQUIRED) before it",
        ),
        ("if(A)\n", "6: this 'if()' has no 'endif()'"),
        ("endif()", "6: 'endif()' stands after no 'if()'"),
        ("foreach(a)", "expected 'endforeach()' before the end of the file"),
        ('message(FATAL_ERROR "no way")', "6: no way"),
        ("include(cmake/more.cmake)", "6: include could not find the file '"),
        ("ament_package()\nrosidl_generate_interfaces(x y)", "7: rosidl_generate_interfaces() must be called before"),
    ],
)
def test_errors_have_file_and_line(read, body, words):
    with pytest.raises(PackageError) as error:
        read(body)
    assert f"CMakeLists.txt:{words}" in str(error.value) or f"CMakeLists.txt: {words}" in str(error.value)


def test_without_the_generators_the_command_is_unknown(read):
    with pytest.raises(
        PackageError, match=r"5: Unknown CMake command .* write find_package\(rosidl_default_generators"
    ):
        read(
            "",
            FRAME.replace("find_package(rosidl_default_generators REQUIRED)", "").replace(
                "find_package(std_msgs REQUIRED)", "rosidl_generate_interfaces(a b.msg)"
            ),
        )


CONDITIONS = st.recursive(
    st.sampled_from(
        [
            ("TRUE", True),
            ("OFF", False),
            ("A", True),
            ("B", False),
            ("A STREQUAL one", True),
            ("DEFINED B", False),
            ("10 GREATER 9", True),
            ("1.10 VERSION_LESS 1.9", False),
            ('A MATCHES "^on"', True),
            ('""', False),
        ]
    ),
    lambda inner: st.one_of(
        inner.map(lambda each: (f"NOT ({each[0]})", not each[1])),
        st.tuples(inner, inner).map(lambda two: (f"({two[0][0]}) AND ({two[1][0]})", two[0][1] and two[1][1])),
        st.tuples(inner, inner).map(lambda two: (f"({two[0][0]}) OR ({two[1][0]})", two[0][1] or two[1][1])),
    ),
    max_leaves=8,
)


@given(st.data())
def test_conditions_hold_as_python_says(tmp_path_factory, data):
    cases = data.draw(st.lists(CONDITIONS, min_size=1, max_size=10))
    body = "set(A one)\n" + "".join(
        f"if({text})\n  list(APPEND SEEN {index})\nendif()\n" for index, (text, _) in enumerate(cases)
    )
    path = tmp_path_factory.getbasetemp() / "conditions.txt"
    path.write_text(f"project(x)\n{body}install(FILES ${{SEEN}} DESTINATION a)\n")
    lists = read_cmake_lists(path)
    assert [each.source for each in lists.files] == [str(index) for index, (_, holds) in enumerate(cases) if holds]
    assert lists.remarks == []


def test_files_of_the_package_are_included(read, tmp_path):
    (tmp_path / "cmake").mkdir()
    (tmp_path / "cmake" / "files.cmake").write_text(
        "set(FILES msg/A.msg)\ninclude(${CMAKE_CURRENT_LIST_DIR}/more.cmake)\n"
    )
    (tmp_path / "cmake" / "more.cmake").write_text("list(APPEND FILES srv/B.srv)\n")
    body = "include(cmake/files.cmake)\ninclude(none.cmake OPTIONAL)\nrosidl_generate_interfaces(robot_msgs ${FILES})"
    assert list(read(body).interfaces) == ["msg/A.msg", "srv/B.srv"]
    (tmp_path / "cmake" / "more.cmake").write_text("\nmessage(FATAL_ERROR no)\n")
    with pytest.raises(PackageError, match=r"cmake/more\.cmake:2: no"):
        read(body)
    (tmp_path / "cmake" / "more.cmake").write_text("include(cmake/files.cmake)\n")
    with pytest.raises(PackageError, match="this file includes itself"):
        read(body)


def test_files_may_be_installed_after_the_package(read):
    assert read("ament_package()\ninstall(DIRECTORY config DESTINATION share)").files[0].source == "config"
