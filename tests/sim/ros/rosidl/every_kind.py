"""The texts of a package in which every kind of field occurs."""

INTEGERS = [f"{sign}{bits}" for bits in (8, 16, 32, 64) for sign in ("int", "uint")]
PLAIN = ["bool", "byte", "char", "float32", "float64", *INTEGERS]
STRINGS = ["string", "string<=5", "wstring", "wstring<=5"]
SHAPES = {"plain": "", "array": "[3]", "bounded": "[<=3]", "sequence": "[]"}


def _fields(shape, suffix):
    kinds = [*PLAIN, *STRINGS, "Inner", "Nothing", "std_msgs/Header"]
    return "\n".join(f"{kind}{suffix} {shape}{index}" for index, kind in enumerate(kinds))


TEXTS = {
    "msg/Nothing.msg": "# an empty message\n",
    "msg/Inner.msg": "uint8 a\nfloat64 b\nNothing c\nstring d\n",
    **{f"msg/{shape.capitalize()}.msg": _fields(shape, suffix) for shape, suffix in SHAPES.items()},
    "msg/Constants.msg": """
        bool YES=true
        byte B=7
        char C=65
        float32 F=-1.5
        int64 LONG=-9223372036854775808
        uint8 HEX=0x1f
        string TEXT=a text, with 'quotes'
        string QUOTED=" spaces "
        wstring WIDE=ü
        """.replace("        ", ""),
    "msg/Defaults.msg": """
        bool yes true
        byte b 7
        float64 f 1e-9
        int8 i -5
        string s "a b"
        string<=5 t abc
        wstring w "ü"
        float32[2] fa [1.5, -2]
        float64[] fs [1, 2, 3]
        uint8[<=4] us [1, 2]
        int64[3] ia [1, 2, 3]
        bool[2] ba [true, false]
        byte[2] ya [1, 2]
        string[] ss ["a, b", 'c']
        """.replace("        ", ""),
    "srv/Ask.srv": "PACKAGE/Plain question\n---\nPACKAGE/Sequence answer\n",
    "action/Do.action": "Bounded goal\n---\nArray result\n---\nInner[] steps\n",
}
MESSAGES = ["Nothing", "Inner", *(shape.capitalize() for shape in SHAPES), "Constants", "Defaults"]
