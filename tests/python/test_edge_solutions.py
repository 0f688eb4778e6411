"""The numbers with which src/algorithms/zone_edges.f90 takes the error of the discretisation off tractions near an edge."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

import mfv

SOURCE = Path(__file__).resolve().parents[2] / "src" / "algorithms" / "zone_edges.f90"


def numbers(name: str) -> np.ndarray:
    """The numbers of a parameter of the module."""
    text = re.search(rf":: {name}\b[^=]*=\s*(?:&\s*)?(\[[^\]]*\]|\S+)", SOURCE.read_text())
    assert text, name
    return np.array([float(value) for value in re.findall(r"(\d+\.\d+)_wp", text[1])])


def logarithm_of_symbol(places: int, aliases: int) -> tuple[np.ndarray, np.ndarray]:
    """Wave numbers, and the logarithm of |2 sin(t/2)|/pi times the symbol of uniform tractions on equal intervals of a half-plane,
    seen at the middles."""
    t = (np.arange(places) + 0.5) * 2 * np.pi / places - np.pi
    symbol = np.zeros(places)
    for k in range(-aliases, aliases + 1):
        symbol += (-1) ** k / (abs(t + 2 * np.pi * k) * (t + 2 * np.pi * k))
    symbol *= 2 * np.pi * np.sin(t / 2)
    return t, np.log(symbol * abs(2 * np.sin(t / 2)) / np.pi)


def test_edge_numbers_follow_from_the_symbol() -> None:
    """g and k from their generating functions; a Wiener-Hopf factor is exp of half the Fourier series."""
    terms = 100
    t, logarithm = logarithm_of_symbol(2**14, 200)
    series = np.array([np.mean(logarithm * np.cos(n * t)) for n in range(terms)])
    factor = np.zeros(terms)  # exp(-sum of series[n] z^n, n > 0)
    factor[0] = 1.0
    first, second = np.ones(terms), np.ones(terms)  # (1 - z)^(-3/2), (1 - z)^(-1/2)
    for n in range(1, terms):
        factor[n] = -sum(m * series[m] * factor[n - m] for m in range(1, n + 1)) / n
        first[n] = first[n - 1] * (n + 0.5) / n
        second[n] = second[n - 1] * (n - 0.5) / n
    at_one = math.exp(-series[1:].sum())
    g = np.convolve(factor, first)[:terms] * math.gamma(1.5) / at_one
    k = np.convolve(factor, second)[:terms] * math.gamma(0.5) / at_one
    # Minus the derivative of the factor's logarithm at z = 1, by the sum of n cos(n t), -1/(4 sin(t/2)^2).
    offset = -np.mean(logarithm / (4 * np.sin(t / 2) ** 2))
    np.testing.assert_allclose(numbers("offset_of_factor"), offset, atol=1e-6)
    j = np.arange(1, 7)
    np.testing.assert_allclose(numbers("of_first"), g[j] ** 2 - (j + 0.75 + offset), atol=2e-6)
    np.testing.assert_allclose(numbers("of_product"), g[j] * k[j] - 1.0, atol=2e-6)
    np.testing.assert_allclose(numbers("of_second"), k[j] ** 2, atol=2e-6)


def test_edges_are_exact_wherever_they_are_between_nodes() -> None:
    """Half-widths of three profiles, in intervals, with the edge anywhere between two nodes: 401 and 101 nodes."""
    kappa = 3 - 4 * 0.3
    half_plane = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
    shapes = [
        (mfv.Body.power(1e-2, 2.0, rigid=True), mfv.reference.power_half_width(0.01, 1e-2, 2.0, 1.0, kappa), 1e-3, 2e-3),
        (mfv.Body.power(1e-2, 4.0, rigid=True), mfv.reference.power_half_width(0.01, 1e-2, 4.0, 1.0, kappa), 1e-2, 1e-1),
        (mfv.Body.rounded_punch(0.5, 100.0, rigid=True), mfv.reference.rounded_punch_half_width(0.01, 0.5, 100.0, 1.0, kappa), 1e-3, 5e-3),
    ]
    for body, exact, fine, coarse in shapes:
        for nodes, bound in ((401, fine), (101, coarse)):
            errors = []
            for margin in (1.2, 1.213, 1.253, 1.31, 1.377, 1.41, 1.5):
                mesh = mfv.Mesh(nodes=nodes, half_width=margin * exact)
                scene = mfv.Scene(
                    half_plane, body, mesh=mesh, friction=mfv.Friction(law="none"), steps=[mfv.Step(normal_force=0.01)]
                )
                found = mfv.run(scene).observables.contact_half_width
                errors.append(abs(found - exact) / (2 * margin * exact / nodes))
            print(body.shape, body.exponent, nodes, max(errors))
            assert max(errors) < bound, (body.shape, nodes)
