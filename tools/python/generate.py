"""Writes `sunfleck/_language.py`: classes of all records and variants of the scene language, from its schema."""

from __future__ import annotations

import json
import keyword
from collections import Counter
from pathlib import Path
from typing import Any

from sunfleck import _native

HEAD = '''"""Records and variants of the scene language; written by `generate.py`, do not edit."""

# ruff: noqa
# mypy: disable-error-code="misc,override,attr-defined,assignment"
from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from ._model import Array, Choice, Record, Unset, Variant, _CLASSES, _TYPES, _VARIANTS, _variant_holds, _variant_keys
'''


def main() -> None:
    types: dict[str, Any] = dict(json.loads(_native.types()))
    variants = {name: list(variants_of(schema)) for name, schema in types.items() if "x-keys" not in schema}
    count = Counter(variant["name"] for of in variants.values() for variant in of)
    taken = set(types)

    def class_of(choice: str, variant: str) -> str:
        return variant if count[variant] == 1 and variant not in taken else choice + variant

    out = [HEAD]
    for name, schema in types.items():
        if name == "Scene":
            continue
        if "x-keys" in schema:
            out.append(keyed(name, "Record", "", schema.get("description", ""), schema["x-keys"]))
            out.append(f'_CLASSES["{name}"] = {name}\n')
            continue
        body = [f'    """{doc(schema.get("description", ""))}"""', "", "    __slots__ = ()", ""]
        body += [f"    {python_name(v['name'])}: ClassVar[type[{class_of(name, v['name'])}]]" for v in variants[name]]
        out.append(f"\nclass {name}(Choice):\n" + "\n".join(body) + "\n")
        out.append(f'_CLASSES["{name}"] = {name}\n_VARIANTS["{name}"] = {{}}\n')
        for variant in variants[name]:
            own = class_of(name, variant["name"])
            base = f"{name}, Variant"
            if "x-keys" in variant:
                out.append(keyed(own, base, variant["name"], variant["doc"], variant["x-keys"]))
            else:
                out.append(holding(own, base, variant))
            out.append(f'{name}.{python_name(variant["name"])} = _VARIANTS["{name}"]["{variant["name"]}"] = {own}\n')
    path = Path(__file__).parent / "python/sunfleck/_language.py"
    lines = (line for text in out for line in text.split("\n"))
    names = sorted({line.split("(")[0].split()[1] for line in lines if line.startswith("class ")})
    out.append("__all__ = [\n" + "".join(f'    "{name}",\n' for name in names) + "]\n")
    path.write_text("\n".join(out))


def variants_of(schema: dict[str, Any]) -> Any:
    for one in schema["anyOf"]:
        yield {**one["x-variant"], "doc": one.get("description", "")}


def python_name(name: str) -> str:
    """Name that Python takes: `None_` in place of `None`."""
    return name + "_" if keyword.iskeyword(name) else name


def doc(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"""', "'''").strip().rstrip('"')


def annotation(schema: dict[str, Any]) -> str:
    if "$ref" in schema:
        return str(schema["$ref"]).rsplit("/", 1)[1]
    if "anyOf" in schema:
        parts = dict.fromkeys(part for one in schema["anyOf"] for part in annotation(one).split(" | "))
        return " | ".join(parts)
    if schema.get("const") == "None":
        return "None"
    kind = schema.get("type")
    if kind == "array" and "prefixItems" in schema:
        return f"tuple[{', '.join(annotation(one) for one in schema['prefixItems'])}]"
    if kind == "array":
        return f"list[{annotation(schema['items'])}]"
    if kind == "object":
        inner = schema.get("additionalProperties")
        return f"dict[str, {annotation(inner)}]" if isinstance(inner, dict) else "Any"
    return {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}.get(str(kind), "Any")


def argument(schema: dict[str, Any]) -> str:
    """Annotation of an argument: arrays will do for tuples and lists."""
    of = annotation(schema)
    of = of.replace("dict[", "Mapping[")
    return f"{of} | Array" if "tuple[" in of or "list[" in of else of


def keyed(name: str, base: str, ron: str, text: str, keys: list[dict[str, Any]]) -> str:
    lines = [f"\nclass {name}({base}):", f'    """{doc(text)}"""', "", "    __slots__ = ()", f'    _ron = "{ron}"', ""]
    for key in keys:
        lines.append(f"    {key['name']}: {annotation(key['schema'])}")
        lines.append(f'    """{doc(key["schema"].get("description", ""))}"""')
    marks = [f"{key['name']}: {argument(key['schema'])} | Unset = ..." for key in keys]
    if marks:
        lines += ["", f"    def __init__(self, *, {', '.join(marks)}) -> None:"]
        given = ", ".join(f"{key['name']}={key['name']}" for key in keys)
        lines.append(f"        super().__init__({given})")
    return "\n".join(lines) + f"\n\n{name}._keys = {{key['name']: key for key in {source(name, ron, base)}}}\n"


def source(name: str, ron: str, base: str) -> str:
    choice = base.split(",")[0]
    return f'_variant_keys("{choice}", "{ron}")' if ron else f'_TYPES["{name}"]["x-keys"]'


def holding(name: str, base: str, variant: dict[str, Any]) -> str:
    head = [f"\nclass {name}({base}):", f'    """{doc(variant["doc"])}"""', "", "    __slots__ = ()"]
    lines = [*head, f'    _ron = "{variant["name"]}"']
    if "holds" not in variant:
        return "\n".join(lines) + "\n"
    choice = base.split(",")[0]
    lines += ["", f"    value: {annotation(variant['holds'])}"]
    holds = variant["holds"]
    if "prefixItems" in holds:
        values = [f"value_{index}: {argument(one)}" for index, one in enumerate(holds["prefixItems"], 1)]
        names = ", ".join(f"value_{index}" for index in range(1, len(values) + 1))
        lines += ["", f"    def __init__(self, {', '.join(values)}, /) -> None:", f"        super().__init__({names})"]
    else:
        lines += ["", f"    def __init__(self, value: {argument(holds)}, /) -> None:"]
        lines.append("        super().__init__(value)")
    lines += ["", f'{name}._holds = _variant_holds("{choice}", "{variant["name"]}")']
    lines += [f'{name}._keys = {{"value": {{"schema": {name}._holds, "default": None}}}}', ""]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
