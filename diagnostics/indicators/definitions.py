"""All indicators of the package, in words; the table in the documentation is made from this list."""

from __future__ import annotations

from diagnostics.indicators.definition import Definition

STILL = "the signal does not vary (standard deviation below 1e-9 of its rms)"
NO_DIFFERENCE = "the difference signal is below 1e-9 of the average (perfect gears)"
NO_LINE = "the mesh line is below 1e-9 of the strongest line, or a sideband is unresolved or outside the band"
NO_HISTORY = "no record of the history varies, or one of them is unusable"
BOOK = "standard literature"
CONDITION_METRICS = "MATLAB gearConditionMetrics"

DEFINITIONS: tuple[Definition, ...] = (
    Definition("rms", "RMS", "record", "sqrt(mean x²)", "m/s²", "Gaussian σ; sine A/√2", "never", BOOK),
    Definition("kurtosis", "Kurtosis", "record", "μ₄/μ₂²", "", "Gaussian 3; sine 1.5", STILL, BOOK),
    Definition("crest_factor", "Crest factor", "record", "max|x|/rms", "", "sine √2", "the signal is zero", BOOK),
    Definition(
        "spectral_kurtosis_maximum",
        "Largest spectral kurtosis",
        "record, Hann frames of 512 samples, half overlapping",
        "max over f of ⟨|X|⁴⟩/⟨|X|²⟩² − 2",
        "",
        "Gaussian about 0; steady tone −1",
        "no band holds power",
        "Antoni 2006; MATLAB pkurtosis has the same formula, other frames",
    ),
    Definition(
        "cepstral_peak",
        "Cepstral peak",
        "record over angle, log spectrum up to 0.8 of the band, mesh lines taken out",
        "largest real cepstrum within one step of one revolution of the shaft",
        "",
        "echo of share a after one revolution: a/2",
        "the record holds no two revolutions of the shaft",
        "Randall 2017",
    ),
    Definition("mesh_amplitude", "Mesh amplitude", "average", "A(h z)", "m/s²", "A cos(h z θ): A", "never", BOOK),
    Definition("average_rms", "RMS of the average", "average", "sqrt(mean x²)", "m/s²", "sine A/√2", "never", BOOK),
    Definition(
        "average_kurtosis",
        "Kurtosis of the average",
        "average",
        "μ₄/μ₂²",
        "",
        "Gaussian 3; sine 1.5",
        STILL,
        f"{BOOK}; {CONDITION_METRICS} takes the average too",
    ),
    Definition(
        "average_crest_factor",
        "Crest factor of the average",
        "average",
        "max|x|/rms",
        "",
        "sine √2",
        "the average is zero",
        f"{BOOK}; {CONDITION_METRICS} takes the average too",
    ),
    Definition(
        "noise_share",
        "Noise share of the average",
        "revolutions and their average",
        "variance between revolutions/(M variance of the average)",
        "",
        "nothing locked to the shaft: 1",
        "fewer than two revolutions",
        "derived",
    ),
    Definition(
        "residual_rms", "RMS of the residual", "residual", "sqrt(mean r²)", "m/s²", "sine A/√2", "never", "Lebold 2000"
    ),
    Definition(
        "difference_rms",
        "RMS of the difference",
        "difference",
        "sqrt(mean d²)",
        "m/s²",
        "sine A/√2",
        "never",
        "Lebold 2000",
    ),
    Definition(
        "fm0",
        "FM0",
        "average",
        "(max x − min x)/Σ A(h z), h = 1 … 5",
        "",
        "single mesh line: 2",
        "the mesh lines are below 1e-9 of the peak-to-peak",
        f"Stewart 1977; {CONDITION_METRICS} takes average and regular signal, so its sum may differ",
    ),
    Definition(
        "fm4",
        "FM4",
        "difference",
        "μ₄/μ₂²",
        "",
        "Gaussian 3; sine 1.5",
        NO_DIFFERENCE,
        f"Stewart 1977; {CONDITION_METRICS} takes the difference too",
    ),
    Definition(
        "m6a",
        "M6A",
        "difference",
        "N² Σd⁶/(Σd²)³",
        "",
        "Gaussian 15; sine 2.5",
        NO_DIFFERENCE,
        f"Martin 1989; {CONDITION_METRICS} takes the difference too",
    ),
    Definition(
        "m8a",
        "M8A",
        "difference",
        "N³ Σd⁸/(Σd²)⁴",
        "",
        "Gaussian 105; sine 4.375",
        NO_DIFFERENCE,
        f"Martin 1989; {CONDITION_METRICS} takes the difference too",
    ),
    Definition(
        "na4",
        "NA4",
        "residual, with the specimen's milder states as history",
        "μ₄(r)/(mean of μ₂ over the history up to this record)²",
        "",
        "first record: Gaussian 3, sine 1.5",
        NO_HISTORY,
        f"Zakrajsek et al. 1993; {CONDITION_METRICS} takes residuals in chronological order",
    ),
    Definition(
        "na4_star",
        "NA4*",
        "residual, with the specimen's healthy records as history",
        "μ₄(r)/(mean of μ₂ over the healthy records)²",
        "",
        "healthy: Gaussian 3; a c-fold residual: 3 c⁴",
        "the specimen has no usable healthy record at this operating point",
        "Decker et al. 1994",
    ),
    Definition(
        "nb4",
        "NB4",
        "envelope of the average within six sidebands of the dominant mesh line, with the same history",
        "NA4's form",
        "",
        "first record: narrow-band Gaussian 3.25",
        NO_HISTORY,
        "Zakrajsek et al. 1994",
    ),
    Definition(
        "energy_ratio",
        "Energy ratio",
        "difference and regular",
        "std(d)/std(g)",
        "",
        "known parts: their ratio",
        "the regular signal does not vary",
        f"Swansson; {CONDITION_METRICS} takes the same ratio",
    ),
    Definition(
        "energy_operator_teager",
        "Energy operator (Teager)",
        "residual",
        "kurtosis of x_i² − x_(i−1) x_(i+1)",
        "",
        "undefined for a tone",
        "the energy does not vary",
        "Ma 1995; Kaiser 1990",
    ),
    Definition(
        "energy_operator_lebold",
        "Energy operator (Lebold)",
        "residual",
        "kurtosis of x_(i+1)² − x_i²",
        "",
        "sine 1.5",
        "the difference does not vary",
        "Lebold 2000",
    ),
    Definition(
        "sideband_index",
        "SI",
        "lines of the average",
        "[A(z − 1) + A(z + 1)]/2",
        "m/s²",
        "AM of index m: A m/2",
        NO_LINE,
        "Szczepanik",
    ),
    Definition(
        "sideband_level_factor",
        "SLF",
        "lines of the average",
        "[A(z − 1) + A(z + 1)]/std(average)",
        "",
        "AM of index m: √2 m/√(1 + m²/2)",
        "the average does not vary",
        "Szczepanik",
    ),
    Definition(
        "sideband_ratio",
        "SER",
        "lines of the average",
        "Σ A(h z ∓ k)/A(h z), k = 1 … 3",
        "",
        "AM of index m: m",
        NO_LINE,
        "Hanna et al. (trademark)",
    ),
    Definition(
        "sideband_power",
        "Sideband power",
        "lines of the average",
        "Σ_h [A²(h z − k) + A²(h z + k)]/Σ_h A²(h z), h = 1 … 5",
        "",
        "AM of index m at order k: m²/2",
        NO_LINE,
        "derived",
    ),
    Definition(
        "sideband_asymmetry",
        "Sideband asymmetry",
        "lines of the average",
        "20 lg A(h z + 1)/A(h z − 1)",
        "dB",
        "AM or PM alone: 0",
        NO_LINE,
        "derived",
    ),
    Definition(
        "amplitude_modulation",
        "AM depth",
        "average within six sidebands of h z, demodulated",
        "order 1 of the amplitude over its mean",
        "",
        "1 + m cos θ: m",
        "the mesh harmonic is zero or the sideband is unresolved",
        "McFadden 1986",
    ),
    Definition(
        "phase_modulation",
        "PM depth",
        "average within six sidebands of h z, demodulated",
        "order 1 of the phase",
        "rad",
        "β sin θ: β",
        "the depth exceeds 1 rad (a mesh line weaker than its sidebands), or the sideband is unresolved",
        "McFadden 1986",
    ),
)
"""In the order of the signal chain."""

BY_NAME = {definition.name: definition for definition in DEFINITIONS}


def definition_table() -> str:
    """Return all definitions as a Markdown table."""
    head = "| column starts with | indicator | taken from | value | unit | on known signals | undefined when | source |"
    rows = [
        f"| `{d.name}` | {d.title} | {d.signal} | {_cell(d.formula)} | {d.unit or '-'} | {d.known} | {d.undefined} | "
        f"{d.source} |"
        for d in DEFINITIONS
    ]
    return "\n".join([head, "|---|---|---|---|---|---|---|---|", *rows])


def _cell(text: str) -> str:
    """Return text in which a bar does not end a cell."""
    return text.replace("|", "\\|")
