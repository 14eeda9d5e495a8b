"""The schema against a validator of its own: protocols that are read pass it, broken ones do not.

Usage: schema_test.py SOURCE_DIR FOVSTUDY TEST_STUDIES_PROTOCOL_ERRORS TEST_STUDIES_LANGUAGE. Exit 77 where python3-jsonschema or python3-yaml
is missing.
"""
import glob
import json
import re
import subprocess
import sys
import tempfile

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}; install python3-jsonschema and python3-yaml")
    sys.exit(77)

source, fovstudy, *writers = sys.argv[1:]


class Loader(yaml.SafeLoader):
    """YAML 1.2, as libfyaml and editors read it: `no` and `off` are words, 1e-3 is a number."""


Loader.yaml_implicit_resolvers = {}
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(true|false)$"), list("tf"))
Loader.add_implicit_resolver("tag:yaml.org,2002:int", re.compile(r"^[-+]?[0-9]+$"), list("-+0123456789"))
Loader.add_implicit_resolver("tag:yaml.org,2002:float",
                             re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"), list("-+.0123456789"))

# What a schema can know: keys, words, ranges, types, what must be there. Not: names that the file itself gives, and
# what a factor's name or a level's value mean.
KNOWABLE = re.compile(
    r"key '|mode '|(camera|kind|method|type) '[^']*' is not known|settings\.moving_objects|parameter of \w+ 'epsilno'|of regular 'epsilon'|"
    r":7:4\d: time_warped\.|seed (is|has)|fovstudy \(|name 'a b'|is a list;|is a mapping;|has no '(title|mode)'|gray_s is|"
    r"factor 'epsilon' has 0|scale is a list")

schema = json.loads(subprocess.run([fovstudy, "schema"], check=True, capture_output=True).stdout)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
failed = 0


def problem(path):
    """The deepest complaint, or None; YAML that cannot be read is a complaint too."""
    try:
        with open(path, encoding="utf-8") as file:  # PyYAML takes no "Which?" in braces, as YAML 1.2 does
            document = yaml.load(re.sub(r"(?<=\S)\?", "\uff1f", file.read()), Loader)
    except yaml.YAMLError as error:
        return str(error)
    found = sorted(validator.iter_errors(document), key=lambda e: len(e.absolute_path))
    return f"{list(found[-1].absolute_path)}: {found[-1].message[:200]}" if found else None


def fail(text):
    global failed
    failed += 1
    print(text)


read = 0
for path in sorted(glob.glob(f"{source}/studies/protocols/*.yaml")):
    check = subprocess.run([fovstudy, "check", path], capture_output=True, text=True)
    complaint = problem(path)
    if "does not exist in this program yet" in check.stderr:
        print(f"{path}: waits for a mode")
    elif check.returncode != 0 or complaint:
        fail(f"{path}: check: {check.stderr.strip()}; schema: {complaint}")
    else:
        read += 1

caught = good = 0
with tempfile.TemporaryDirectory() as folder:
    for writer in writers:
        subprocess.run([writer, "--keep", folder], check=True, capture_output=True)
    for path in sorted(glob.glob(f"{folder}/*.yaml")):
        with open(path, encoding="utf-8") as file:
            sentence = file.readline()[2:].strip()
        complaint = problem(path)
        if complaint and sentence:
            caught += 1
        elif complaint:
            fail(f"{path} is read, but: {complaint}")
        elif KNOWABLE.search(sentence):
            fail(f"not caught: {sentence}")
        else:
            good += not sentence

print(f"{read} protocols and {good} examples pass, {caught} broken ones do not")
sys.exit(1 if failed or read < 2 or good < 100 or caught < 30 else 0)
