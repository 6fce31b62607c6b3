"""A wheel without an index: what scikit-build-core does with pyproject.toml, by CMake and this file.

usage: python3 make_wheel.py FOLDER [-D NAME=VALUE]...     e.g. -D KAIROS_WITH_GSL=OFF

Builds in build/wheel and writes FOLDER/kairos-...whl, which `pip install --no-index` takes. The wheel
links the shared libraries of this distribution (fmt, and GSL and SUNDIALS where they are used).
"""

import base64
import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def build(definitions, stage):
    """The files of the wheel below `stage`, as scikit-build-core lays them out."""
    with open(os.path.join(SOURCE, "pyproject.toml"), "rb") as file:
        project = tomllib.load(file)
    options = project["tool"]["scikit-build"]
    name, version = project["project"]["name"], project["project"]["version"]
    data = os.path.join(stage, f"{name}-{version}.data")
    folder = os.path.join(SOURCE, "build", "wheel")
    wanted = {"CMAKE_BUILD_TYPE": options["cmake"]["build-type"], "SKBUILD": "2",
              "SKBUILD_SCRIPTS_DIR": os.path.join(data, "scripts"),
              "SKBUILD_DATA_DIR": os.path.join(data, "data"), "Python_EXECUTABLE": sys.executable,
              **options["cmake"]["define"], **definitions}
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja",
                    *(f"-D{key}={value}" for key, value in wanted.items())], check=True)
    subprocess.run(["cmake", "--build", folder], check=True)
    for component in options["install"]["components"]:
        subprocess.run(["cmake", "--install", folder, "--prefix", stage, "--component", component],
                       check=True)
    return project["project"]


def describe(project, stage):
    """Metadata (PEP 427, PEP 621); returns the name of the wheel."""
    name, version = project["name"], project["version"]
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
    info = os.path.join(stage, f"{name}-{version}.dist-info")
    os.makedirs(info)
    lines = ["Metadata-Version: 2.1", f"Name: {name}", f"Version: {version}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {need}" for need in project["dependencies"]]
    for extra, needs in project["optional-dependencies"].items():
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {need}; extra == "{extra}"' for need in needs]
    with open(os.path.join(info, "METADATA"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    with open(os.path.join(info, "WHEEL"), "w", encoding="utf-8") as file:
        file.write("Wheel-Version: 1.0\nGenerator: make_wheel\nRoot-Is-Purelib: false\n"
                   f"Tag: {tag}\n")
    shutil.copy(os.path.join(SOURCE, project["license"]["file"]), info)
    return f"{name}-{version}-{tag}.whl", f"{name}-{version}.dist-info/RECORD"


def pack(stage, wheel, record):
    paths = sorted(os.path.relpath(os.path.join(folder, file), stage)
                   for folder, _, files in os.walk(stage) for file in files)
    rows = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in paths:
            with open(os.path.join(stage, path), "rb") as file:
                content = file.read()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            rows.append(f"{path},sha256={digest},{len(content)}")
            archive.write(os.path.join(stage, path), path)
        archive.writestr(record, "\n".join([*rows, f"{record},,"]) + "\n")


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        sys.exit(__doc__)
    out, rest = arguments[0], arguments[1:]
    if len(rest) % 2 or any(flag != "-D" for flag in rest[::2]):
        sys.exit(__doc__)
    definitions = dict(setting.split("=", 1) for setting in rest[1::2])
    with tempfile.TemporaryDirectory(prefix="kairos-wheel-") as stage:
        project = build(definitions, stage)
        name, record = describe(project, stage)
        os.makedirs(out, exist_ok=True)
        pack(stage, os.path.join(out, name), record)
    print(os.path.join(out, name))


if __name__ == "__main__":
    main(sys.argv[1:])
