"""Case files for tests and benchmarks: the sections that every gas has, and bodies."""


def vector(values):
    return "[" + ", ".join(f"{value:.10g}" for value in values) + "]"


def inlet(velocity):
    """`velocity`: superficial, m/s."""
    return f'type = "inlet", superficial_velocity = {velocity:.10g}'


def boundary(side, condition):
    """`condition`: a type, or all keys of the side."""
    keys = condition if "=" in condition else f'type = "{condition}"'
    return f"{side} = {{{keys}}}\n"


def gas_case(upper, cells, *, below, above="outlet", x="slip", y="slip", lower=(0, 0, 0),
             density=1.2, viscosity=1.8e-5, gravity=None):
    """Sections grid, gas and boundary. `x`, `y`: conditions of both sides along that axis; lengths
    in m, density in kg/m^3, viscosity in Pa s."""
    weight = f"gravity = {vector(gravity)}\n" if gravity else ""
    conditions = {"x_lower": x, "x_upper": x, "y_lower": y, "y_upper": y, "z_lower": below,
                  "z_upper": above}
    return (f"[grid]\nlower = {vector(lower)}\nupper = {vector(upper)}\ncells = {list(cells)}\n"
            f"[gas]\ndensity = {density:.10g}\nviscosity = {viscosity:.10g}\n{weight}"
            "[boundary]\n" + "".join(boundary(*side) for side in conditions.items()))


def plane(point, normal):
    return f"plane = {{point = {vector(point)}, normal = {vector(normal)}}}"


def body(name, shape, acts_on=""):
    """`shape`: a line; `acts_on`: grains, gas, or nothing for both."""
    only = f'acts_on = ["{acts_on}"]\n' if acts_on else ""
    return f'[[body]]\nname = "{name}"\n{only}{shape}\n'


def changed(text, old, new):
    """A case that differs in one place, which must be there."""
    assert text.count(old) == 1, (old, text)
    return text.replace(old, new)
