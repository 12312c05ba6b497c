"""Objects of the scene language: records of keys, and variants of choices.

Each key that is set is held as it is written: numbers, texts, formulas ("=name"), tuples, lists, dictionaries and other
objects. Keys that are not set have their defaults.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Iterator, Mapping
from types import EllipsisType
from typing import Any, ClassVar, TypeAlias

import numpy as np

from . import _native
from ._native import SceneError

Schema: TypeAlias = dict[str, Any]
Array: TypeAlias = "np.ndarray[Any, np.dtype[Any]]"
Unset: TypeAlias = EllipsisType

_TYPES: dict[str, Schema] = dict(json.loads(_native.types()))
_CLASSES: dict[str, type[Node]] = {}
_VARIANTS: dict[str, dict[str, type[Variant]]] = {}


class _Checked(type):
    """Classes whose unknown keys are told with the nearest one."""

    def __call__(cls, *values: Any, **keys: Any) -> Any:
        known = getattr(cls, "_keys", {})
        for key in keys:
            if key not in known:
                raise SceneError(_unknown_key(getattr(cls, "_ron", "") or cls.__name__, key, known))
        return super().__call__(*values, **keys)


def _unknown_key(of: str, key: str, known: Iterable[str]) -> str:
    near = difflib.get_close_matches(key, known, 1)
    meant = f": did you mean `{near[0]}`?" if near else f"; it has {_listed(known)}"
    return f"`{of}` has no key `{key}`{meant}"


class Node(metaclass=_Checked):
    """An object of a scene."""

    __slots__ = ("_owner", "_set")

    _keys: ClassVar[dict[str, Schema]] = {}
    _ron: ClassVar[str] = ""

    _set: dict[str, Any]
    _owner: tuple[Node, str] | None

    def __init__(self, **keys: Any) -> None:
        object.__setattr__(self, "_set", {})
        object.__setattr__(self, "_owner", None)
        for key, value in keys.items():
            if value is not ...:
                self._put(key, value)

    def _put(self, key: str, value: Any) -> None:
        if key not in self._keys:
            raise SceneError(self._unknown(key))
        value = _shaped(self._keys[key]["schema"], value)
        self._set[key] = self._owned(key, value)

    def _owned(self, key: str, value: Any) -> Any:
        if isinstance(value, Node):
            object.__setattr__(value, "_owner", (self, key))
        elif isinstance(value, Items):
            value._owner = (self, key)
            for one in value.values():
                if isinstance(one, Node):
                    object.__setattr__(one, "_owner", (self, key))
        elif isinstance(value, list | tuple):
            for one in value:
                if isinstance(one, Node):
                    object.__setattr__(one, "_owner", (self, key))
        return value

    def _unknown(self, key: str) -> str:
        return _unknown_key(self._ron or type(self).__name__, key, self._keys)

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_") or key not in self._keys:
            raise AttributeError(self._unknown(key))
        if key in self._set:
            return self._set[key]
        default = self._default(key)
        if isinstance(default, Items | list):
            # What is put into it later belongs to this object.
            self._set[key] = default
        return default

    def _default(self, key: str) -> Any:
        default = self._keys[key]["default"]
        if default is None:
            raise AttributeError(f"`{self._ron or type(self).__name__}` has no `{key}` yet, and no default")
        value = _read(self._keys[key]["schema"], _native.tree(default, key))
        return self._owned(key, value)

    def __setattr__(self, key: str, value: Any) -> None:
        before = dict(self._set)
        self._put(key, value)
        self._changed(lambda: object.__setattr__(self, "_set", before))

    def __delattr__(self, key: str) -> None:
        before = dict(self._set)
        if self._set.pop(key, None) is None and key not in self._keys:
            raise AttributeError(self._unknown(key))
        self._changed(lambda: object.__setattr__(self, "_set", before))

    def _changed(self, undo: Any) -> None:
        """Tells the scene that this object belongs to; an object that was a default becomes a value."""
        if self._owner is None:
            return
        owner, key = self._owner
        held = owner._set.get(key)
        if held is None:
            owner._set[key] = self
        owner._changed(undo)

    def __dir__(self) -> Iterable[str]:
        return [*self._keys, *super().__dir__()]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._written() == other._written()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        keys = ", ".join(f"{key}={value!r}" for key, value in self._written().items())
        return f"{type(self).__name__}({keys})"

    def _written(self) -> dict[str, Any]:
        """Keys that are written: an empty list or dictionary in place of an empty one is not."""
        return {
            key: value
            for key, value in self._set.items()
            if not (isinstance(value, Items | list) and not value and self._keys[key]["default"] in ("[]", "{}"))
        }

    def _text(self) -> str:
        inner = ", ".join(f"{key}: {ron(value)}" for key, value in self._written().items())
        return f"({inner})"


class Record(Node):
    """A record of keys."""

    __slots__ = ()


class Choice(Node):
    """One of several variants."""

    __slots__ = ()


class Variant(Choice):
    """A variant of a choice: a word, a word with keys, or a word with one value (`value`)."""

    __slots__ = ()

    _holds: ClassVar[Schema | None] = None

    def __init__(self, *values: Any, **keys: Any) -> None:
        super().__init__(**keys)
        if values:
            value = values[0] if len(values) == 1 else tuple(values)
            self._put("value", value)

    def _text(self) -> str:
        if self._holds is not None:
            value = self._set.get("value")
            inner = ", ".join(map(ron, value)) if isinstance(value, tuple) else ron(value)
            return f"{self._ron}({inner})"
        return f"{self._ron}{super()._text()}" if self._written() else self._ron


class Items(dict[str, Any]):
    """Named objects of a scene; a name that is not there is told with the nearest one."""

    def __init__(self, values: Mapping[str, Any], schema: Schema) -> None:
        super().__init__({key: _shaped(schema, value) for key, value in values.items()})
        self._schema = schema
        self._owner: tuple[Node, str] | None = None

    def __missing__(self, name: str) -> Any:
        near = difflib.get_close_matches(name, self, 1)
        meant = f": did you mean `{near[0]}`?" if near else f"; there are {_listed(self)}"
        raise KeyError(f"there is no `{name}`{meant}")

    def __setitem__(self, name: str, value: Any) -> None:
        before = dict(self)
        value = _shaped(self._schema, value)
        if self._owner is not None and isinstance(value, Node):
            object.__setattr__(value, "_owner", self._owner)
        super().__setitem__(name, value)
        if self._owner is not None:
            self._owner[0]._changed(lambda: self._back_to(before))

    def _back_to(self, before: dict[str, Any]) -> None:
        self.clear()
        self.update(before)


def _listed(names: Iterable[str]) -> str:
    names = [f"`{name}`" for name in names]
    return ", ".join(names[:12]) + (", .." if len(names) > 12 else "") if names else "none"


def _class_of(schema: Schema) -> str | None:
    reference = schema.get("$ref")
    return None if reference is None else str(reference).rsplit("/", 1)[1]


def _alternatives(schema: Schema) -> list[Schema]:
    if "anyOf" not in schema:
        return [schema]
    return [inner for one in schema["anyOf"] for inner in _alternatives(one)]


def _shaped(schema: Schema, value: Any) -> Any:
    """A value with the tuples, lists and dictionaries that its key has; arrays of numpy and pandas are taken too."""
    if isinstance(value, Node) or value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if hasattr(value, "to_numpy"):
        value = value.to_numpy()
    if isinstance(value, np.ndarray):
        value = value.tolist()
    for one in _alternatives(schema):
        name = _class_of(one)
        if name in _TYPES and isinstance(value, list | tuple) and "anyOf" in _TYPES[name]:
            continue
        if one.get("type") == "array" and isinstance(value, list | tuple):
            if "prefixItems" in one:
                return tuple(
                    _shaped(item, inner) for item, inner in zip(one["prefixItems"], value, strict=False)
                ) + tuple(value[len(one["prefixItems"]) :])
            return [_shaped(one["items"], inner) for inner in value]
        if isinstance(value, Mapping):
            if one.get("type") == "object" and isinstance(one.get("additionalProperties"), dict):
                return Items(value, one["additionalProperties"])
            if name in _CLASSES and issubclass(_CLASSES[name], Record):
                return _CLASSES[name](**value)
    return list(value) if isinstance(value, Iterator) else value


def _read(schema: Schema, tree: Any) -> Any:
    """Value of a tree of the native part."""
    if not isinstance(tree, tuple):
        return tree
    kind, holds = tree
    if kind == "named" and holds[0] == "None" and any(one.get("const") == "None" for one in _alternatives(schema)):
        return None
    if kind == "named" and holds[0] == "Some" and holds[1] is not None:
        return _read(schema, holds[1][1][0])
    for one in _alternatives(schema):
        name = _class_of(one)
        if name is not None:
            found = _object(name, kind, holds)
            if found is not None:
                return found
        elif one.get("type") == "array" and kind in ("list", "tuple"):
            if "prefixItems" in one and kind == "tuple":
                return tuple(_read(item, inner) for item, inner in zip(one["prefixItems"], holds, strict=False))
            if "items" in one and kind == "list":
                return [_read(one["items"], inner) for inner in holds]
        elif kind == "map" and isinstance(one.get("additionalProperties"), dict):
            inner = one["additionalProperties"]
            return Items({key: _read(inner, value) for key, value in holds}, inner)
    raise SceneError(f"a value of kind `{kind}` is not meant here")


def _object(name: str, kind: str, holds: Any) -> Node | None:
    if kind == "named":
        variant = _VARIANTS.get(name, {}).get(holds[0])
        return None if variant is None else _variant(variant, holds[1])
    cls = _CLASSES.get(name)
    if cls is not None and issubclass(cls, Record) and (kind == "record" or (kind == "tuple" and not holds)):
        return _record(cls, holds)
    return None


def _record(cls: type[Node], fields: Any) -> Node:
    made = cls.__new__(cls)
    Node.__init__(made)
    for key, tree in fields:
        if key not in cls._keys:
            raise SceneError(made._unknown(key))
        made._set[key] = made._owned(key, _read(cls._keys[key]["schema"], tree))
    return made


def _variant(cls: type[Variant], body: Any) -> Variant:
    if cls._holds is None:
        made = _record(cls, body[1] if body is not None else [])
        assert isinstance(made, Variant)
        return made
    made = cls.__new__(cls)
    Node.__init__(made)
    of = body[1] if body is not None else []
    is_flat = any("prefixItems" in one for one in _alternatives(cls._holds)) and len(of) > 1
    tree = ("tuple", of) if is_flat else of[0]
    made._set["value"] = made._owned("value", _read(cls._holds, tree))
    return made


def ron(value: Any) -> str:
    """Text of a value in the scene language."""
    if isinstance(value, Node):
        return value._text()
    if isinstance(value, bool):
        return "true" if value else "false"
    if value is None:
        return "None"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise SceneError(f"{value} is no number that a scene can hold")
        return repr(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, tuple):
        return f"({', '.join(map(ron, value))})"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_quoted(key)}: {ron(one)}" for key, one in value.items()) + "}"
    if isinstance(value, np.generic | np.ndarray):
        return ron(value.tolist())
    if isinstance(value, Iterable):
        return f"[{', '.join(map(ron, value))}]"
    raise SceneError(f"a scene holds no {type(value).__name__}")


def _quoted(text: str) -> str:
    escapes = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}
    letters = (escapes.get(c) or (f"\\u{{{ord(c):x}}}" if ord(c) < 32 or ord(c) == 127 else c) for c in text)
    return '"' + "".join(letters) + '"'


def _variant_of(choice: str, name: str) -> Schema:
    return next(one["x-variant"] for one in _TYPES[choice]["anyOf"] if one["x-variant"]["name"] == name)


def _variant_keys(choice: str, name: str) -> list[Schema]:
    keys: list[Schema] = _variant_of(choice, name)["x-keys"]
    return keys


def _variant_holds(choice: str, name: str) -> Schema:
    holds: Schema = _variant_of(choice, name)["holds"]
    return holds
