"""Time steps of a scene from the properties of its original particles."""

import math


def contact_time(radius, density, spring, restitution):
    """Duration of a contact of two original particles, s (half period of the damped spring)."""
    mass = density * 4 / 3 * math.pi * radius**3
    damping_ratio = -math.log(restitution) / math.hypot(math.pi, math.log(restitution))
    return math.pi * math.sqrt(mass / 2 / spring) / math.sqrt(1 - damping_ratio**2)


def time_step(duration, exchange):
    """Largest step of at most an eighth of the contact time, whole steps between exchanges, s."""
    return exchange / math.ceil(exchange / (duration / 8))
