# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors
"""Builds the wheel of the Python module: the hooks of PEP 517, with CMake and nothing else.

--config-settings build-dir=DIR takes a build folder that is there already; without it one is made in build/pip.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))


def _version():
    with open(os.path.join(ROOT, "include", "thermopower", "version.hpp"), encoding="utf-8") as file:
        return ".".join(re.findall(r"_number\(\) \{ return (\d+); \}", file.read()))


def _built(settings):
    folder = (settings or {}).get("build-dir") or os.path.join(ROOT, "build", "pip")
    if not os.path.exists(os.path.join(folder, "CMakeCache.txt")):
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DTHERMOPOWER_PYTHON=ON",
                        "-DTHERMOPOWER_TOOLS=OFF", "-DTHERMOPOWER_EXAMPLES=OFF", "-DTHERMOPOWER_TESTS=OFF",
                        f"-DPython_EXECUTABLE={sys.executable}"], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "thermopower_python"], check=True)
    return os.path.join(folder, "python", "thermopower")


def _metadata():
    return ("Metadata-Version: 2.1\nName: thermopower\n" f"Version: {_version()}\n"
            "Summary: Where a simulated actuator and the real one part, and which effect is missing\n"
            "License: MIT\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = _built(config_settings)
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    name = f"thermopower-{_version()}"
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    module = f"_thermopower{suffix}"
    if not os.path.exists(os.path.join(package, module)):
        raise SystemExit(f"thermopower: {package} has no {module}; it was built for another Python than {sys.executable}")
    files = {}
    for one in ("__init__.py", "__init__.pyi", "py.typed", module):
        with open(os.path.join(package, one), "rb") as file:
            files[f"thermopower/{one}"] = file.read()
    info = f"{name}.dist-info"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: thermopower\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    with open(os.path.join(ROOT, "LICENSE"), "rb") as file:
        files[f"{info}/LICENSE"] = file.read()
    record = ""
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"{name}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            archive.writestr(path, content)
    return wheel
