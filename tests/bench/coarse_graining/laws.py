"""Contact laws under comparison, as lines of a LIGGGHTS script.

Every script says `coarsegraining l model_check warn`, so that grains, skins and the gas see the
same l. What stock LIGGGHTS makes of its properties under that command is in docs/coarse_graining.md:
kn x l, gamman_abs x l^2, kt and gammat_abs unscaled, Young's modulus unscaled.

    cgm-n1, cgm-n2, cgm-n3   ours with stiffness exponent n, fused engine, SDF walls
    stock-cg                 stock hooke/stiffness with the coarse graining compiled into it
    stock-hooke, stock-hertz larger grains with the original's Young's modulus and restitution
    stock-hand               stock hooke/stiffness with k and damping scaled by hand as l^3
Stock laws run with stock walls and stock time integration (`gasgrain_engine off`).
"""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Material:
    """Properties of the original particle."""
    diameter: float  # m
    density: float  # kg/m^3
    spring: float  # k, N/m
    restitution: float  # e, -
    friction: float  # mu, -
    impact_speed: float  # m/s, the characteristic velocity of stock `hooke`
    poisson_ratio: float = 0.3
    wall_friction: float | None = None  # mu at walls; None: that between grains

    @property
    def mass(self):
        return self.density * math.pi / 6 * self.diameter**3

    def damping(self, effective_mass):
        """eta of the law of docs/coarse_graining.md, kg/s."""
        ln_e = math.log(self.restitution)
        return -2 * ln_e * math.sqrt(effective_mass * self.spring / (math.pi**2 + ln_e**2))

    def contact_time(self):
        """Of two original particles, s."""
        ln_e = math.log(self.restitution)
        return math.sqrt((math.pi**2 + ln_e**2) * self.mass / 2 / self.spring)

    def youngs_modulus(self):
        """The one with which stock `hooke` has the stated spring between two originals, Pa.

        k = 16/15 sqrt(r) Y (15 m V^2 / (16 sqrt(r) Y))^(1/5) of the LIGGGHTS manual, solved for Y,
        which is half of the particles' modulus over 1 - nu^2.
        """
        radius, mass = self.diameter / 4, self.mass / 2  # effective
        effective = (self.spring / ((16 / 15) ** 0.8 * radius**0.4
                                    * (mass * self.impact_speed**2) ** 0.2)) ** 1.25
        return 2 * (1 - self.poisson_ratio**2) * effective


def pair_property(name, pair, wall):
    return (f"fix {name} all property/global {name} peratomtypepair 2 {pair:.10g}"
            + 3 * f" {wall:.10g}")


def type_property(name, value):
    return f"fix {name} all property/global {name} peratomtype {value:.10g} {value:.10g}"


@dataclasses.dataclass(frozen=True)
class Law:
    name: str
    exponent: float  # n: the contact time grows as l^((3 - n)/2)
    stock: bool = True

    def properties(self, material, l):
        """Lines of property/global fixes."""
        e, mu = material.restitution, material.friction
        wall_mu = mu if material.wall_friction is None else material.wall_friction
        lines = [pair_property("coefficientFriction", mu, wall_mu)]
        if not self.stock:
            return lines + [pair_property("cgmSpringConstant", material.spring, material.spring),
                            pair_property("coefficientRestitution", e, e)]
        if self.name in ("stock-hooke", "stock-hertz"):
            return lines + [
                type_property("youngsModulus", material.youngs_modulus()),
                type_property("poissonsRatio", material.poisson_ratio),
                pair_property("coefficientRestitution", e, e),
                "fix V all property/global characteristicVelocity scalar "
                f"{material.impact_speed:.10g}"]
        # stock multiplies kn by l and gamman_abs by l^2 on its own
        k, pair, wall = material.spring, material.damping(material.mass / 2), material.damping(
            material.mass)
        normal_k, normal_eta, shear = (1, 1, 1) if self.name == "stock-cg" else (l**2, l, l**3)
        return lines + [pair_property("kn", normal_k * k, normal_k * k),
                        pair_property("kt", shear * k, shear * k),
                        pair_property("gamman_abs", normal_eta * pair, normal_eta * wall),
                        pair_property("gammat_abs", shear * pair, shear * wall)]

    def model(self, walls=""):
        """What follows `model` in pair_style gran and fix wall/gran."""
        if not self.stock:
            return f"cgm tangential history stiffness_exponent {self.exponent:g}"
        name = self.name.removeprefix("stock-")
        if name in ("hooke", "hertz"):
            return f"{name} tangential history {walls}"
        return (f"hooke/stiffness tangential history {walls} absolute_damping on "
                "tangential_damping on limitForce off")

    def contact_time(self, material, l):
        return material.contact_time() * l ** ((3 - self.exponent) / 2)


LAWS = {law.name: law for law in (
    Law("cgm-n3", 3, stock=False), Law("cgm-n2", 2, stock=False), Law("cgm-n1", 1, stock=False),
    Law("stock-cg", 1), Law("stock-hooke", 1), Law("stock-hertz", 1), Law("stock-hand", 3))}
