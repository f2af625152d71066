"""Node trees as they are evaluated: without groups, reroutes and muted nodes, and with nodes of our own between them.

Nothing of Blender's data is changed. Outputs can be described as JSON, of which rebuild.py makes nodes in another Blender.
"""
import bpy


class Output:
    """An output of a node. A tree has one object for each."""

    def __init__(self, node, index, name, type_):
        self.node, self.index, self.name, self.type = node, index, name, type_


class Input:
    """An input: its `source`, an Output, or None and its plain `default_value`; that is None for shaders."""

    def __init__(self, name, identifier, type_, source, default_value):
        self.name, self.identifier, self.type, self.source, self.default_value = name, identifier, type_, source, default_value


class _Inputs(list):
    def __getitem__(self, key):
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = self.get(key)
        if found is None:
            raise KeyError(key)
        return found

    def __contains__(self, name):
        return self.get(name) is not None

    def get(self, name):
        return next((i for i in self if i.name == name), None)


class Node:
    """A node of Blender; its properties are the attributes."""

    def __init__(self, tree, origin, groups):
        self._tree, self.origin, self.groups = tree, origin, groups
        self.type, self.name = origin.type, origin.name
        self._outputs, self._inputs = {}, None

    @property
    def inputs(self):
        if self._inputs is None:
            self._inputs = _Inputs(self._tree.read(s, self.groups) for s in self.origin.inputs)
        return self._inputs

    def output(self, index):
        if index not in self._outputs:
            socket = self.origin.outputs[index]
            self._outputs[index] = Output(self, index, socket.name, socket.type)
        return self._outputs[index]

    def plain_output(self):
        """Returns the value of a node that has it at its output."""
        return self.origin.outputs[0].default_value

    def __getattr__(self, name):
        return getattr(object.__getattribute__(self, "origin"), name)


class Made:
    """A node of our own: `kind` without "ShaderNode", the values of its inputs, which may be outputs, and properties."""
    groups = ()

    def __init__(self, kind, type_, *values, **properties):
        self.kind, self.type, self.name, self.properties = kind, type_, "", properties
        self.inputs = _Inputs(Input(str(i), i, None, v if isinstance(v, Output) else None, None if isinstance(v, Output) else v)
                              for i, v in enumerate(values))

    def output(self, index=0, type_='VALUE', name=""):
        return Output(self, index, name, type_)

    def __getattr__(self, name):
        return object.__getattribute__(self, "properties")[name]


def computed(operation, a, b):
    """Returns the output of a Math node of our own."""
    return Made('Math', 'MATH', a, b, operation=operation).output()


class Constant(Made):
    """A node of a plain value: a number, or a colour as three."""

    def __init__(self, value):
        if isinstance(value, tuple):
            super().__init__('MixRGB', 'RGB', 0.0, (*value, 1.0), (*value, 1.0), blend_type='MIX')
        else:
            super().__init__('Math', 'VALUE', value, 0.0, operation='ADD')

    def plain_output(self):
        return self.inputs[1 if self.type == 'RGB' else 0].default_value


class Tree:
    """Reads the evaluated node tree of `owner`, a material, light or world. `replaced(node, name)` returns another output for that of a
    Node of this name, or None."""

    def __init__(self, owner, replaced=lambda node, name: None):
        self.owner, self._nodes, self._links, self._replaced = owner, {}, {}, replaced
        output = owner.node_tree.get_output_node('CYCLES')
        self.output = None if output is None else self._node(output, ())

    def _node(self, origin, groups):
        key = origin.as_pointer(), tuple(g.as_pointer() for g in groups)
        if key not in self._nodes:
            self._nodes[key] = Node(self, origin, groups)
        return self._nodes[key]

    def _link(self, socket):
        """Returns the link to an input; sockets themselves look through all links of a tree."""
        tree = socket.id_data
        links = self._links.get(tree)
        if links is None:
            links = self._links[tree] = {l.to_socket.as_pointer(): l for l in tree.links if not l.is_muted}
        return links.get(socket.as_pointer())

    def read(self, socket, groups):
        """Returns an Input of the evaluated tree."""
        wanted, found = socket, None
        while socket is not None and (link := self._link(socket)) is not None:
            node, output = link.from_node, link.from_socket
            if node.type == 'REROUTE':
                socket = node.inputs[0]
            elif node.mute:
                socket = next((l.from_socket for l in node.internal_links if l.to_socket == output), None)
            elif node.type == 'GROUP_INPUT':
                socket, groups = (groups[-1].inputs[_index(node.outputs, output)], groups[:-1]) if groups else (None, groups)
            elif node.type == 'GROUP' and node.node_tree:
                results = [n for n in node.node_tree.nodes if n.type == 'GROUP_OUTPUT']
                result = next((n for n in results if n.is_active_output), results[0] if results else None)
                socket, groups = (result.inputs[_index(node.outputs, output)] if result else None), (*groups, node)
            else:
                if output.type == 'SHADER' and wanted.type != 'SHADER':  # Cycles leaves such links out
                    socket = wanted
                    break
                node = self._node(node, groups)
                found = self._replaced(node, output.name) or node.output(_index(node.origin.outputs, output))
                break
        value = getattr(socket if socket is not None else wanted, "default_value", None) if found is None else None
        return Input(wanted.name, wanted.identifier, wanted.type, found, converted(value, wanted.type))


def all_nodes(tree):
    """Yields the nodes of a tree of Blender, and of its groups."""
    for node in tree.nodes:
        yield node
        if node.type == 'GROUP' and node.node_tree:
            yield from all_nodes(node.node_tree)


def _index(sockets, socket):
    return next(i for i, s in enumerate(sockets) if s == socket)


def converted(value, type_):
    """Returns a plain value as a socket of another type has it: a number, or a tuple."""
    if value is None or isinstance(value, str) or type_ in ('SHADER', 'STRING'):
        return None if type_ == 'SHADER' else value
    try:
        values = tuple(value)
    except TypeError:
        values = None
    if type_ in ('RGBA', 'VECTOR'):
        if values is None:
            values = (float(value),) * 3
        return (*values[:3], 1.0) if type_ == 'RGBA' and len(values) == 3 else values if type_ == 'RGBA' else values[:3]
    if values is None:
        return value
    return grey(*values[:3]) if len(values) == 4 else sum(values[:3]) / 3


def grey(red, green, blue):
    """Returns the number that nodes make of a colour."""
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def is_output(value):
    return isinstance(value, Output)


def value_of(socket):
    """Returns an input's source, or its plain value: a number, or three."""
    source = socket.source
    if source is not None and source.node.type not in ('RGB', 'VALUE'):
        return source
    kind = 'RGBA' if socket.type == 'SHADER' else socket.type
    value = socket.default_value if source is None else converted(source.node.plain_output(), kind)
    return value if isinstance(value, (int, float)) else tuple(value)[:3]


def upstream(output):
    """Returns the nodes that an output depends on, and the names of their outputs that it uses."""
    found, todo = {}, [output]
    while todo:
        at = todo.pop()
        is_new = at.node not in found
        found.setdefault(at.node, set()).add(at.name)
        if is_new:
            todo += [i.source for i in at.node.inputs if i.source is not None]
    return found


def described(output, place):
    """Returns the nodes that an output depends on, as JSON for rebuild.built(). `place` tells the data-block in whose tree they are."""
    numbers, made = {}, []

    def add(node):
        if node in numbers:
            return numbers[node]
        inputs = [{"from": [add(i.source.node), i.source.index]} if i.source is not None else {"value": _plain(i.default_value)}
                  for i in node.inputs]
        if isinstance(node, Made):
            made.append({"make": "ShaderNode" + node.kind, "set": node.properties, "inputs": inputs})
        else:
            made.append({"copy": [*place, *(g.name for g in node.groups), node.name], "inputs": inputs,
                         "set": _properties(node.origin), "object": _place(node.origin),
                         "alpha": node.type == 'TEX_IMAGE' and node.origin.outputs['Alpha'].is_linked})
        numbers[node] = len(made) - 1
        return numbers[node]

    return {"node": add(output.node), "output": output.index, "nodes": made}


def _plain(value):
    return list(value) if isinstance(value, tuple) else value if isinstance(value, (int, float, str, bool)) else None


def _place(origin):
    """Returns where the object is whose coordinates a node has, as JSON; None without one."""
    o = origin.object if origin.type == 'TEX_COORD' else None
    return o and [list(row) for row in o.matrix_world]


def _properties(origin):
    """Returns the properties of a node that may be animated."""
    if origin.id_data.animation_data is None:
        return {}
    base = bpy.types.ShaderNode.bl_rna.properties
    return {p.identifier: getattr(origin, p.identifier) for p in origin.bl_rna.properties
            if p.type in ('FLOAT', 'INT', 'BOOLEAN') and not p.is_readonly and not p.is_array and p.identifier not in base}
