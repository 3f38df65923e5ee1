"""Values of the wrong type: what arithmetic, comparisons, calls and indices got instead of a number or a list.

Source: the error texts of CPython 3.11 and 3.12 and of NumPy 2.
"""

from __future__ import annotations

import re

from gz_course.grader.feedback.errors import explanation

BEFORE = ("libraries",)

NUMBERS = frozenset({"int", "float", "float32", "float64", "numpy.float64"})
LISTS = frozenset({"list", "tuple", "array.array"})
DATA = re.compile(r"(?:String|Bool|Float\d+|U?Int\d+)$")
VECTORS = frozenset({"Vector3", "Point", "Quaternion", "Twist", "Pose"})
OPERATION = re.compile(r"unsupported operand type\(s\) for ([^:]+): '([\w.]+)' and '([\w.]+)'")
COMPARISON = re.compile(r"'([<>]=?)' not supported between instances of '([\w.]+)' and '([\w.]+)'")
CONVERSION = re.compile(r"(float|int)\(\) argument must be .* not '([\w.]+)'")
NO_LIST = re.compile(
    r"'([\w.]+)' object is not (iterable|subscriptable)|object of type '([\w.]+)' has no (len)\(\)|"
    r"cannot (unpack) non-iterable ([\w.]+) object"
)
NO_CALL = re.compile(r"TypeError: '([\w.]+)' object is not callable")

# Type of an object -> what is taken instead of it, where a number belongs.
INSTEAD = {
    "Parameter": "a parameter's value is its .value: self.get_parameter('NAME').value",
    "Duration": "a Duration is no number: compare a Duration with a Duration, Duration(seconds=5.0) of rclpy.duration, "
    "or calculate with its .nanoseconds / 1e9, which are seconds",
    "Future": "a Future has no result yet: spin until it is done(), then take .result()",
    "method": "a function is given where its result is needed: brackets are missing after its name",
    "function": "a function is given where its result is needed: brackets are missing after its name",
    "builtin_function_or_method": "a function is given where its result is needed: brackets are missing after its name",
    "Odometry": "that is the whole message: the position is in .pose.pose.position, the speed in .twist.twist.linear",
    "LaserScan": "that is the whole message: the distances are in its field ranges",
    "Imu": "that is the whole message: its fields are orientation, angular_velocity and linear_acceleration",
}


@explanation
def operands(error: str, code: str) -> str:
    """Explain an operator between values that do not go together."""
    if match := OPERATION.search(error) or COMPARISON.search(error):
        return _pair(match[1], match[2], match[3])
    if match := CONVERSION.search(error):
        return _single(match[2]) if code or ("method" not in match[2] and "function" not in match[2]) else ""
    if "can't multiply sequence by non-int" in error:
        return "a text or a list is multiplied by a number: float(text) makes a number of a text; a list has elements"
    if match := re.search(r"can only (?:append|concatenate) (?:array|list|tuple) \(not \"(\w+)\"\)", error):
        return f"+ joins two lists of the same type, and one side is a {match[1]}: list(...) makes a list of an array"
    if match := re.search(r"bad operand type for (?:abs\(\)|unary [-+]): '([\w.]+)'", error):
        return _single(match[1])
    if "must be real number, not" in error:
        return _single(error.rpartition(" ")[2])
    return ""


def _pair(sign: str, left: str, right: str) -> str:
    both = {left, right}
    if ("Time" in both and both <= {"Time", "int", "float"}) or both == {"Time", "Duration"}:
        return _times(sign, left, right)
    for kind in (left, right):
        if kind in INSTEAD:
            return INSTEAD[kind]
    if "NoneType" in both:
        return (
            "the start has not been set when it is subtracted: set it, if it is None, before"
            if sign == "-" and both & {"Time", "float", "int"}
            else "one side is None: it was never set, or it is the result of a function that returns nothing"
        )
    for kind in (left, right):
        if kind == "str" and both & NUMBERS:
            return "one side is a text: float(text) makes a number of it; a number gets into a text by f'{value}'"
        if said := _single(kind):
            return said
    return ""


def _times(sign: str, left: str, right: str) -> str:
    if left == right:
        return (
            "one of the two is the stamp of a message, which cannot be used in calculations: "
            "rclpy.time.Time.from_msg(stamp) makes a Time of it, and stamp.sec + stamp.nanosec / 1e9 are seconds"
        )
    if sign in "<>=":
        return "a Time is compared with a Time; seconds that have passed are (now - start).nanoseconds / 1e9"
    return (
        "a Time minus a Time is a Duration, whose .nanoseconds / 1e9 are seconds; numbers and Times do not mix, a Time "
        "and a Duration do: Time + Duration(seconds=5.0)"
    )


def _single(kind: str) -> str:
    """Explain one value where a number belongs; empty if nothing is certain."""
    if kind in INSTEAD:
        return INSTEAD[kind]
    if kind == "NoneType":
        return "the value is None: it was never set, or it is the result of a function that returns nothing"
    if kind in LISTS:
        return (
            "a whole list is given where one number is needed: take one element, values[i], or min(values); numpy's "
            "np.array(values) is computed element by element"
        )
    if kind == "dict" or kind == "set":
        return f"a {kind}, {{...}}, is given where a number is needed: take the value out of it"
    if DATA.match(kind):
        return f"that is the message {kind}, not its value: .data is the value"
    if kind in VECTORS:
        return f"that is a whole {kind}: take one of its numbers, such as .x"
    if kind == "Time":
        return "a Time is no number: time.nanoseconds / 1e9 are seconds"
    return ""


@explanation
def lists(error: str, code: str) -> str:
    """Explain what is no list."""
    match = NO_LIST.search(error)
    if match is None:
        return ""
    kind, how = match[1] or match[3] or match[6], match[2] or match[4] or match[5]
    if kind in NUMBERS:
        if kind == "int" and how == "iterable" and code.startswith("for "):
            return "for goes through a list or a range: for i in range(n)"
        wanted = "indexed with [...]" if how == "subscriptable" else "gone through or unpacked like a list"
        return f"that is one number, which cannot be {wanted}: min(), max(), sum() and for take the whole list"
    if kind in ("LaserScan", "Odometry", "Imu") or DATA.match(kind):
        return INSTEAD.get(kind) or f"that is the whole message {kind}: what it carries is in its field data"
    if kind in VECTORS:
        return f"a {kind} is no list: its numbers are the fields .x, .y and .z"
    if kind in ("method", "function", "builtin_function_or_method"):
        return INSTEAD[kind]
    if kind == "NoneType":
        return "that is None: it was never set, or it is the result of a function that returns nothing"
    if kind == "Parameter":
        return INSTEAD[kind]
    return ""


@explanation
def indices(error: str, code: str) -> str:
    """Explain an index that does not fit."""
    if re.search(r"(?:list|tuple) indices must be integers or slices, not tuple", error):
        return "a list of lists is indexed grid[row][column]; grid[row, column] needs an array of NumPy"
    if re.search(r"(?:list|tuple) indices must be integers or slices, not str", error):
        return (
            "the items of a list have numbers, not names: one that is found by its name is found by going through the "
            "list, for each in ...: if each.name == ..."
        )
    if re.search(r"(?:array|list|tuple|string) ind(?:ices|exes) must be integers|only integers, slices", error):
        return (
            "an index is a whole number, and / always gives a float: // divides without a remainder, int() rounds off"
        )
    if re.search(r"IndexError: (?:array|list|tuple|string) (?:assignment )?index out of range", error):
        return "there is no element of that number: the first is 0, the last is len(...) - 1"
    if match := re.search(r"IndexError: index (-?\d+) is out of bounds for axis (\d+) with size (\d+)", error):
        return (
            f"the index is {match[1]}, but there are {match[3]} elements along axis {match[2]}, 0 to "
            f"{int(match[3]) - 1}; an image or a map is indexed [row, column], that is [y, x]"
        )
    return ""


@explanation
def arrays(error: str, code: str) -> str:
    """Explain what an array or a list does not have, and a number of values that does not fit."""
    if match := re.search(r"'array\.array' object has no attribute '(\w+)'", error):
        name = match[1]
        if name in ("length", "size", "shape", "len", "count_", "getLength"):
            return "how many there are is len(values)"
        call = f"{name}(values)" if name in ("min", "max", "sum") else f"np.array(values).{name}"
        return f"the list of a message is an array of Python, not of NumPy: {call}"
    if match := re.search(
        r"'list' object has no attribute '(min|max|sum|mean|shape|size|length|argmin|argmax)'", error
    ):
        return (
            f"a list of Python has no {match[1]}; min(values), max(values), sum(values) and len(values) are functions"
        )
    if match := re.search(r"(too many|not enough) values to unpack \(expected (\d+)", error):
        return f"there are {match[1].replace('not enough', 'fewer')} values than the {match[2]} names before the ="
    return ""


@explanation
def calls(error: str, code: str) -> str:
    """Explain a call of what is no function."""
    match = NO_CALL.search(error)
    if match is None:
        return ""
    kind = match[1]
    if kind == "NoneType":
        return (
            "a callback is passed without brackets, self.on_timer; self.on_timer() calls it at once and hands over None"
        )
    if kind == "module":
        return "that is a module; the function or class in it is called, time.time() or Twist() of geometry_msgs.msg"
    if kind == "Publisher":
        return "a publisher is not called itself: publisher.publish(message); or it has the name of a method"
    if kind == "QoSProfile":
        return "this profile is an object already: pass it without brackets"
    if kind == "RcutilsLogger":
        return "the logger is not called itself: self.get_logger().info('text')"
    if kind == "bool" and re.search(r"\bis_(?:cancel_requested|active)\(", code):
        return "is_cancel_requested and is_active of a goal handle are truth values: they are written without brackets"
    if kind in ("float", "int", "bool", "str", "list", "tuple", "dict", "Timer", "Subscription", "array.array"):
        return (
            f"a {kind} is called like a function: a variable has taken the name of a function (self.x = ... hides "
            "def x), brackets stand where [...] belong, or an operator is missing before the brackets"
        )
    if kind[:1].isupper():
        return (
            f"an object of {kind} is called like a function: {kind}() makes one, and no second pair of brackets follows"
        )
    return ""
