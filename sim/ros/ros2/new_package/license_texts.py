"""The licenses that `ros2 pkg create --license` knows by their identifiers, and the text of a LICENSE file.

Source: https://spdx.org/licenses/ (identifiers and texts)
Source: ament_copyright 0.17 (which ones ROS 2 knows)
"""

from __future__ import annotations

KNOWN = (
    *("Apache-2.0", "BSL-1.0", "BSD-2-Clause", "BSD-3-Clause", "GPL-3.0-only", "LGPL-2.1-only", "LGPL-3.0-only"),
    *("MIT", "MIT-0"),
)
_DISTRIBUTION = "gz-ros2-course"


def text(license_name: str, holder: str) -> str:
    """Return the text of a license; empty for one whose text is not here."""
    if license_name == "Apache-2.0":
        return _own_license()
    return _TEXTS.get(license_name, "").format(holder=holder)


def _own_license() -> str:
    """Return the license of the course itself, which is Apache-2.0."""
    from importlib import metadata  # takes longer than the rest

    try:
        files = metadata.files(_DISTRIBUTION) or []
        return next((str(file.read_text()) for file in files if file.name == "LICENSE"), "")
    except (metadata.PackageNotFoundError, OSError):
        return ""


_COPYRIGHT = "Copyright (c) {holder}\n\n"
_MIT_GRANT = """\
Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so"""
_MIT_NOTICE = """, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.
"""
_MIT_WARRANTY = """
THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
"""
_BSD_GRANT = """\
Redistribution and use in source and binary forms, with or without
modification, are permitted provided that the following conditions are met:

1. Redistributions of source code must retain the above copyright notice, this
   list of conditions and the following disclaimer.

2. Redistributions in binary form must reproduce the above copyright notice,
   this list of conditions and the following disclaimer in the documentation
   and/or other materials provided with the distribution.
"""
_BSD_NAMES = """
3. Neither the name of the copyright holder nor the names of its
   contributors may be used to endorse or promote products derived from
   this software without specific prior written permission.
"""
_BSD_WARRANTY = """
THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS"
AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE
IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE
FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR
SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER
CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY,
OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE
OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""
_TEXTS = {
    "MIT": "MIT License\n\n" + _COPYRIGHT + _MIT_GRANT + _MIT_NOTICE + _MIT_WARRANTY,
    "MIT-0": "MIT No Attribution\n\n" + _COPYRIGHT + _MIT_GRANT + ".\n" + _MIT_WARRANTY,
    "BSD-2-Clause": "BSD 2-Clause License\n\n" + _COPYRIGHT + _BSD_GRANT + _BSD_WARRANTY,
    "BSD-3-Clause": "BSD 3-Clause License\n\n" + _COPYRIGHT + _BSD_GRANT + _BSD_NAMES + _BSD_WARRANTY,
}
