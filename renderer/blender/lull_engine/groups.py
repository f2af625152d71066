"""Puts the nodes of groups into the tree that uses them."""

_OF_THE_TREE = {"rna_type", "type", "inputs", "outputs", "internal_links", "dimensions", "bl_idname", "bl_label", "bl_description",
                "bl_icon", "bl_static_type", "bl_width_default", "bl_width_min", "bl_width_max", "bl_height_default",
                "bl_height_min", "bl_height_max", "parent", "location", "select", "name"}


def inline(tree):
    """Replaces groups, of any depth, and removes muted nodes, which exporters take for others. Groups without a tree stay."""
    while group := next((n for n in tree.nodes if n.type == 'GROUP' and n.node_tree and not n.mute), None):
        _expand(tree, group)
    for node in [n for n in tree.nodes if n.mute]:
        for output in node.outputs:
            inside = next((link.from_socket for link in node.internal_links if link.to_socket == output), None)
            if inside is not None:
                replace(tree, output, inside)
        tree.nodes.remove(node)


def _copy(node, tree):
    made = tree.nodes.new(node.bl_idname)
    for p in node.bl_rna.properties:
        if p.identifier in _OF_THE_TREE:
            continue
        if p.is_readonly:
            _copy_parts(getattr(node, p.identifier), getattr(made, p.identifier))
            continue
        try:
            setattr(made, p.identifier, getattr(node, p.identifier))
        except (AttributeError, TypeError):
            pass
    for mine, other in zip(made.inputs, node.inputs):
        if hasattr(other, "default_value"):
            try:
                mine.default_value = other.default_value
            except (AttributeError, TypeError):
                pass
    for mine, other in zip(made.outputs, node.outputs):
        if hasattr(other, "default_value"):  # of values and colours, which have it there
            mine.default_value = other.default_value
    return made


def _copy_parts(old, new):
    """Copies ramps and curves, which are part of a node."""
    kind = type(old).__name__
    if kind == 'ColorRamp':
        for name in "color_mode", "interpolation", "hue_interpolation":
            setattr(new, name, getattr(old, name))
        while len(new.elements) < len(old.elements):
            new.elements.new(0.5)
        for mine, other in zip(new.elements, old.elements):
            mine.position, mine.color = other.position, other.color
    elif kind == 'CurveMapping':
        for mine, other in zip(new.curves, old.curves):
            while len(mine.points) < len(other.points):
                mine.points.new(0.5, 0.5)
            for a, b in zip(mine.points, other.points):
                a.location, a.handle_type = b.location, b.handle_type
        new.update()
    elif kind in ('TexMapping', 'ColorMapping', 'ImageUser'):
        for p in old.bl_rna.properties:
            if not p.is_readonly:
                try:
                    setattr(new, p.identifier, getattr(old, p.identifier))
                except (AttributeError, TypeError):
                    pass


def replace(tree, output, source):
    """Links what an output is linked to to another output, or to that of an input, or sets it to the input's plain value."""
    if not source.is_output and source.links:
        source = source.links[0].from_socket
    for link in list(output.links):
        _connect(tree, source, link.to_socket)


def _connect(tree, source, socket):
    """Links a socket to an output, or sets it to the plain value of an input."""
    if source.is_output:
        tree.links.new(source, socket)
        return
    for link in list(socket.links):
        tree.links.remove(link)
    if hasattr(socket, "default_value") and hasattr(source, "default_value"):
        _set(socket, source.default_value)


def copy_into(tree, nodes):
    """Copies nodes of another tree, with the links between them. Returns the copies by their originals."""
    made = {n: _copy(n, tree) for n in nodes}
    for link in [l for n in nodes for s in n.inputs for l in s.links if l.from_node in made]:
        tree.links.new(made[link.from_node].outputs[list(link.from_node.outputs).index(link.from_socket)],
                       made[link.to_node].inputs[list(link.to_node.inputs).index(link.to_socket)])
    return made


def _expand(tree, group):
    inner = group.node_tree
    made = copy_into(tree, [n for n in inner.nodes if n.type not in ('GROUP_INPUT', 'GROUP_OUTPUT', 'FRAME')])
    outputs = [n for n in inner.nodes if n.type == 'GROUP_OUTPUT']
    result = next((n for n in outputs if n.is_active_output), outputs[0] if outputs else None)

    def source(link):
        """Returns the socket of the outer tree that a link of the group comes from, or a socket with a plain value."""
        node = link.from_node
        if node.type == 'GROUP_INPUT':
            outside = group.inputs[list(node.outputs).index(link.from_socket)]
            return outside.links[0].from_socket if outside.links else outside
        return made[node].outputs[list(node.outputs).index(link.from_socket)]

    for link in inner.links:
        if link.from_node.type != 'GROUP_INPUT' or link.to_node not in made:
            continue
        target = made[link.to_node].inputs[list(link.to_node.inputs).index(link.to_socket)]
        _connect(tree, source(link), target)
    if result is not None:
        for i, outside in enumerate(group.outputs):
            inside = result.inputs[i]
            for link in list(outside.links):
                target = link.to_socket
                if inside.links:
                    _connect(tree, source(inside.links[0]), target)
                elif hasattr(inside, "default_value") and hasattr(target, "default_value"):
                    _set(target, inside.default_value)
    tree.nodes.remove(group)


def _set(socket, value):
    """Sets a plain value of another type, as nodes convert it."""
    try:
        values = list(value)
    except TypeError:
        values = None
    try:
        wants = list(socket.default_value)
    except TypeError:
        wants = None
    if wants is None:
        socket.default_value = value if values is None else sum(values[:3]) / 3
    elif values is None:
        socket.default_value = [value] * 3 + [1] * (len(wants) - 3)
    else:
        socket.default_value = (values + [1])[:len(wants)]
