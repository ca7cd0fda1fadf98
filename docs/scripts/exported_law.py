"""Forces of an exported model, from its arrays alone (docs/reference/exported_model.md).

Plain Python on purpose: it can be read beside the page, and shares no code with siggen.
"""

import math
from dataclasses import dataclass

import numpy as np


@dataclass
class Forces:
    """ΣN [N], ΣF [N], Σ s F [N m], Σμ [N m] and Σ ζ F [N m] of all pairs."""

    normal: float = 0.0
    friction: float = 0.0
    friction_moment: float = 0.0
    across: float = 0.0
    friction_across: float = 0.0


@dataclass
class State:
    """Approach and its rate, sliding speed v = sliding_0 + s sliding_1, tilt and its rate; SI."""

    approach: float
    rate: float
    sliding_0: float = 0.0
    sliding_1: float = 0.0
    tilt: float = 0.0
    tilt_rate: float = 0.0


@dataclass
class Pair:
    """One pair at an angle: row and cell of its tables, whole stiffness, position, what is missing, its penetration."""

    row: int
    cell: int
    weight: float
    whole: float
    position: float
    offset: float
    missing: float
    number: int
    side: int = 0
    penetration: float = 0.0
    touching: bool = False


@dataclass
class Spring:
    """Elastic force of a pair with its stiffness, carrying share, share on rough land, moment and its derivatives."""

    force: float = 0.0
    slope: float = 0.0
    carrying: float = 1.0
    rough: float = 0.0
    moment: float = 0.0
    cross: float = 0.0
    turning: float = 0.0


def place_in(count, place):
    """Return the cell of a table with `count` points, and the weight of its upper end; kept at the ends."""
    place = min(max(place, 0.0), count - 1.0)
    cell = min(int(place), count - 2)
    return cell, place - cell


def between(rows, cell, weight):
    """Return the value of a table (points,) in a cell, linear."""
    return rows[cell] * (1.0 - weight) + rows[cell + 1] * weight


class LinearLaw:
    """`law: linear`: stiffness of all pairs times the approach beyond half the backlash."""

    def __init__(self, model):
        self.model, self.rows = model, model["law.stiffness"].tolist()

    def forces(self, state, pitches):
        """Return the forces of a state at a pinion angle in base pitches."""
        model, gap = self.model, float(self.model["law.half_backlash_m"])
        if gap > 0 and abs(state.approach) <= gap:
            return Forces()
        stiffness = 0.0
        teeth_1, teeth_2 = model["law.table_of_pair"].shape
        for n in range(math.floor(pitches), math.floor(pitches - model["law.contact_ratio"]), -1):
            row = self.rows[model["law.table_of_pair"][n % teeth_1, n % teeth_2]]
            stiffness += between(row, *place_in(len(row), (pitches - n) * model["law.intervals_per_pitch"]))
        beyond = state.approach - math.copysign(gap, state.approach)
        return Forces(stiffness * beyond + model["law.damping_n_s_per_m"] * state.rate)


class PairLaw:
    """`law: pairs`: every pair with its own spring, damper and friction."""

    def __init__(self, model):
        self.model = {
            name[4:]: value.tolist()  # plain numbers and lists: single elements of arrays are slow
            for name, value in model.items()
            if name.startswith("law.")
        }
        self.lead = self.model["contact.lead_m"]
        self.before = {}
        self.nodes = [self.model["contact.unit_m"] * k**2 for k in range(len(self.model["contact.curves"][0]))]

    def forces(self, state, pitches):
        """Return the forces of a state at a pinion angle in base pitches."""
        pairs = self.pairs(state, pitches)
        if "coupling_m_per_n" in self.model and sum(pair.side != 0 for pair in pairs) > 1:
            self.share(pairs, state.tilt)
        springs = [self.spring(pair, pair.penetration, state.tilt) for pair in pairs]
        total = sum(spring.slope for spring in springs if spring.force != 0.0)
        sums = Forces()
        for pair, spring in zip(pairs, springs, strict=True):
            if spring.force != 0.0:
                self.add(sums, pair, spring, state, 1.0 / math.sqrt(total) if total > 0.0 else 0.0)
        self.before = {pair.number: spring.force for pair, spring in zip(pairs, springs, strict=True)}
        return sums

    def pairs(self, state, pitches):
        """Return the pairs in reach."""
        law = self.model
        found = []
        last = pitches - law["contact_ratio"] - law["reach_after"]
        number = math.floor(pitches + law["reach_before"])
        while number > last:
            one, two = number % len(law["offset_1"]), number % len(law["offset_2"])
            row, since = law["table_of_pair"][one][two], pitches - number
            cell, weight = place_in(len(law["stiffness"][row]), since * law["intervals_per_pitch"])
            kinds = law["missing_1"][law["kind_of_tooth_1"][one]], law["missing_2"][law["kind_of_tooth_2"][two]]
            at = place_in(len(kinds[0]), (since + law["reach_before"]) * law["missing_intervals_per_pitch"])
            offset = law["offset_1"][one] + law["offset_2"][two]
            pair = Pair(
                row, cell, weight,
                whole=between(law["stiffness"][row], cell, weight),
                position=law["start_m"] + since * law["base_pitch_m"],
                offset=offset,
                missing=offset + self.lead + between(kinds[0], *at) + between(kinds[1], *at),
                number=number,
            )  # fmt: skip
            pair.penetration = state.approach - pair.missing
            ahead = abs(state.tilt) * law["contact.half_face_m"]  # of one end of the face
            pair.side = 1 if pair.penetration + ahead > 0.0 else 0
            behind = state.approach - 2.0 * offset + pair.missing + law["backlash_m"]
            if pair.penetration <= 0.0 and behind < 0.0:
                pair.side, pair.penetration = -1, behind
            found.append(pair)
            number -= 1
        return found

    def share(self, pairs, tilt):
        """Replace the penetrations by those under the forces of the other pairs: Newton's method on the forces."""
        table = self.model["coupling_m_per_n"]
        coupling = np.zeros((len(pairs), len(pairs)))
        for i, later in enumerate(pairs):
            for j in range(len(pairs)):
                if 0 < j - i <= len(table):
                    coupling[i, j] = coupling[j, i] = between(table[j - i - 1], later.cell, later.weight)
        alone = np.array([pair.penetration for pair in pairs])
        force = np.array([self.before.get(pair.number, 0.0) for pair in pairs])
        for _ in range(60):
            under = alone - coupling @ force
            springs = [self.spring(pair, depth, tilt) for pair, depth in zip(pairs, under, strict=True)]
            slopes = np.array([spring.slope if spring.force != 0.0 else 0.0 for spring in springs])
            wrong = np.array([spring.force for spring in springs]) - force
            step = np.linalg.solve(np.eye(len(pairs)) + slopes[:, None] * coupling, wrong)
            force = force + step
            if np.abs(step).max() <= 1e-9 * max(np.abs(force).max(), 1e-12):
                break
        for pair, depth in zip(pairs, alone - coupling @ force, strict=True):
            pair.penetration = float(depth)

    def spring(self, pair, depth, tilt):
        """Return the spring of a pair at a penetration."""
        if pair.side < 0:
            return Spring(pair.whole * depth, pair.whole) if depth < 0.0 else Spring()
        return self.spring_of_face(pair, depth - self.touch(pair), tilt)

    def touch(self, pair):
        """Return the approach at which a pair first touches."""
        return between(self.model["contact.touch_m"][pair.row], pair.cell, pair.weight)

    def spring_of_face(self, pair, approach, tilt):
        """Return the spring from the table of the contact across the face."""
        law = self.model
        if law["contact.half_face_m"] > 0.0:
            return self.tilted(pair, approach, tilt * law["contact.half_face_m"])
        if approach <= 0.0:
            return Spring()
        ends, over, span = self.ends(pair, approach, 0)
        t = min(over / span, 1.0)
        force, slope, _ = cubic(ends[0][0:2], ends[1][0:2], over, span)
        return Spring(force, slope, *(ends[0][k] * (1.0 - t) + ends[1][k] * t for k in (2, 3)))

    def ends(self, pair, way, ray):
        """Return the values of a ray at the nodes before and behind a way, the way behind the first, the span."""
        law, nodes = self.model, self.nodes
        column = law["contact.column"][pair.row][pair.cell] + law["contact.gain"][pair.row][pair.cell] * pair.weight
        whole = min(int(column), len(law["contact.curves"]) - 2)
        node = min(int(math.sqrt(way / nodes[1])), len(nodes) - 2)
        share, span, over = column - whole, nodes[node + 1] - nodes[node], way - nodes[node]
        pairs = ((law["contact.curves"][whole + k][n][ray] for k in (0, 1)) for n in (node, node + 1))
        found = [[a * (1.0 - share) + b * share for a, b in zip(*both, strict=True)] for both in pairs]
        return found, over, span

    def tilted(self, pair, approach, lift):
        """Return the spring from the energy along rays of approach and lift of the ends of the face."""
        radius = math.hypot(approach, lift)
        if radius <= 1e-15 or abs(lift) >= RAYS[-1] * (radius + approach):
            return Spring()
        place = lift / (radius + approach)
        if abs(place) <= NEAR:
            (_, w_r, w_rr), (w_p, w_rp, _), w_pp, shares = self.beside(pair, radius, place)
        else:
            ray = max(k for k in range(len(RAYS) - 1) if RAYS[k] <= place)
            ends = [(RAYS[k], *self.along(pair, radius, k)) for k in (ray, ray + 1) if RAYS[k] != 0.0]
            if len(ends) == 1:  # the ray beside that without tilt is where this one begins
                at = math.copysign(NEAR, place)
                ends.append((at, *self.beside(pair, radius, at)))
                ends[1] = (*ends[1][:3], ends[1][4])
                ends.sort(key=lambda end: end[0])
            (first, low, low_across, low_shares), (second, high, high_across, high_shares) = ends
            width, x = second - first, (place - first) / (second - first)
            # Hermite's cubic in the place between two rays, for the energy and its derivatives to the radius.
            found = [cubic((low[k], low_across[k]), (high[k], high_across[k]), x * width, width) for k in range(3)]
            (_, w_p, w_pp), (w_r, w_rp, _), (w_rr, _, _) = found
            shares = [a * (1.0 - x) + b * x for a, b in zip(low_shares, high_shares, strict=True)]
        turn = 0.5 * (1.0 + place**2)  # dp/dφ
        per_angle, per_angle_2 = turn * w_p, turn * (turn * w_pp + place * w_p)
        # Second derivatives along and across the radius, cut to what a convex energy has.
        along, across = max(w_rr, 0.0), max(per_angle_2 / radius**2 + w_r / radius, 0.0)
        most = math.sqrt(along * across)
        mixed = min(max((turn * w_rp - per_angle / radius) / radius, -most), most)
        c, s, half = approach / radius, lift / radius, self.model["contact.half_face_m"]
        force = c * w_r - s * per_angle / radius
        if force <= 0.0:
            return Spring()
        spring = Spring(force, c * c * along - 2.0 * c * s * mixed + s * s * across)
        spring.moment = half * (s * w_r + c * per_angle / radius)
        spring.cross = half * (c * s * (along - across) + (c * c - s * s) * mixed)
        spring.turning = half**2 * (s * s * along + 2.0 * c * s * mixed + c * c * across)
        spring.carrying, spring.rough = shares
        return spring

    def beside(self, pair, radius, place):
        """Return W, W_r, W_rr at a small place, the same of its derivative to it, W_pp and both shares.

        The energy is that without tilt, to the second order in the place.
        """
        upright = RAYS.index(0.0)
        (_, force, slope), across, shares = self.along(pair, radius, upright)
        (first, second), over, span = self.ends(pair, radius, upright)
        turning, growing, growing_2 = cubic(first[6:8], second[6:8], over, span)
        _, _, slope_2 = cubic(first[0:2], second[0:2], over, span)
        # W without tilt: at the node before it stands on the ray beside, from there on it is the force's integral.
        energy = self.ends(pair, radius, upright + 1)[0][0][7] + gained(first, second, over, span)
        # W_pp = 4 r (r T - F), T = dM/dθ / h², and its derivatives to the radius.
        bent = (
            4.0 * radius * (radius * turning - force),
            4.0 * (2.0 * radius * turning + radius**2 * growing - force - radius * slope),
            4.0 * (2.0 * (turning - slope) + radius * (4.0 * growing + radius * growing_2 - slope_2)),
        )
        values = [
            w + place * w_p + 0.5 * place**2 * w_pp
            for w, w_p, w_pp in zip((energy, force, slope), across, bent, strict=True)
        ]
        return values, [w_p + place * w_pp for w_p, w_pp in zip(across, bent, strict=True)], bent[0], shares

    def along(self, pair, radius, ray):
        """Return W, W_r, W_rr of a ray, the same of its derivative to the place, and both shares."""
        (first, second), over, span = self.ends(pair, radius, ray)
        pushed = cubic((first[0], first[1]), (second[0], second[1]), over, span)
        across = cubic((first[4], first[5]), (second[4], second[5]), over, span)
        t, energy = min(over, span) / span, first[6] + gained(first, second, over, span)
        shares = [first[k] * (1.0 - t) + second[k] * t for k in (2, 3)]
        return (energy, *pushed[:2]), across, shares

    def add(self, sums, pair, spring, state, shared):
        """Add the forces of a pair that touches: spring, damper, moment, friction."""
        damping = self.root(pair, spring) * shared
        normal = spring.force + damping * (spring.slope * state.rate + spring.cross * state.tilt_rate)
        if pair.side * normal <= 0.0:
            return
        moment = spring.moment + damping * (spring.cross * state.rate + spring.turning * state.tilt_rate)
        sums.normal += normal
        sums.across += moment
        if not self.model["rubs"]:
            return
        for share, place in self.parts(pair):
            _, coefficient = self.lubricated(place, spring, abs(normal))
            sliding = state.sliding_0 + place * state.sliding_1
            friction = share * coefficient * abs(normal) * math.tanh(sliding / self.model["friction.slip_speed_m_s"])
            sums.friction += friction
            sums.friction_moment += place * friction
            sums.friction_across += friction * moment / normal

    def parts(self, pair):
        """Return shares of the load and their places: of helical pairs before and behind the pitch point."""
        if "spread" not in self.model:
            return [(1.0, pair.position)]
        before, first, second = (between(row, pair.cell, pair.weight) for row in self.model["spread"])
        return [(before, pair.position + first), (1.0 - before, pair.position + second)]

    def root(self, pair, spring):
        """Return the root of the damper, in parts where the asperities have a say."""
        law = self.model
        if "damping_root_kg" in law:
            return law["damping_root_kg"]
        if pair.side < 0:
            return law["damping_structure_root_kg"] + law["damping_film_root_kg"]
        share, _ = self.lubricated(pair.position, spring, spring.force)
        film, asperities = law["damping_film_root_kg"], law["damping_asperities_root_kg"]
        return law["damping_structure_root_kg"] + film * (1.0 - share) + asperities * share

    def lubricated(self, position, spring, force):
        """Return the share of the load on asperities and the friction coefficient, at force over carrying share."""
        law, line = self.model, self.model["friction.table.line_m"]
        fluids = law["friction.table.fluid"]
        along, a = place_in(len(fluids), (position - law["friction.table.start_m"]) * law["friction.table.per_m"])
        held = law["friction.table.start_m"] + (along + a) / law["friction.table.per_m"]
        load = force / max(spring.carrying, 1e-3) * line / (law["friction.table.floor_n_per_m"] * held * (line - held))
        up, b = place_in(len(fluids[0]), math.log(max(load, 1.0)) * law["friction.table.per_log"])

        def read(table):
            low = between([row[up] for row in table[along : along + 2]], 0, a)
            return low * (1.0 - b) + between([row[up + 1] for row in table[along : along + 2]], 0, a) * b

        shares = [read(table) for table in law["friction.table.share"]]
        share = shares[0] if len(shares) == 1 else shares[0] * (1.0 - spring.rough) + shares[1] * spring.rough
        boundary = law["friction.boundary"]
        return share, share * boundary + (1.0 - share) * min(read(fluids), boundary)


RAYS = [-1.0 - math.sqrt(2.0), -1.5, -0.8, -0.3, 0.0, 0.3, 0.8, 1.5, 1.0 + math.sqrt(2.0)]
"""tan(φ/2) of the rays, φ the angle from no tilt in the plane of approach and lift."""
NEAR = 0.04
"""Up to here the energy follows from the face without tilt."""


def gained(first, second, over, span):
    """Return the integral of the cubic through force and slope at two nodes, from the first one to `over` [J]."""
    within = min(over, span)
    t, rise = within / span, (second[0] - first[0]) / span
    bend, twist = 3.0 * rise - 2.0 * first[1] - second[1], first[1] + second[1] - 2.0 * rise
    energy = within * (first[0] + within * (first[1] / 2.0 + t * (bend / 3.0 + t * twist / 4.0)))
    return energy + (over - within) * (second[0] + 0.5 * (over - within) * second[1])


def cubic(left, right, over, span):
    """Return value and two derivatives of Hermite's cubic at `over` of `span`; beyond it the last slope goes on."""
    (f_0, s_0), (f_1, s_1) = left, right
    if over > span:
        return f_1 + s_1 * (over - span), s_1, 0.0
    t, rise = over / span, (f_1 - f_0) / span
    bend, twist = 3.0 * rise - 2.0 * s_0 - s_1, s_0 + s_1 - 2.0 * rise
    value = f_0 + over * (s_0 + t * (bend + t * twist))
    return value, s_0 + t * (2.0 * bend + 3.0 * t * twist), (2.0 * bend + 6.0 * t * twist) / span


LAWS = {"linear": LinearLaw, "pairs": PairLaw}
