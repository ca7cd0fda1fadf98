"""Cepstrum and spectral kurtosis on signals whose values are known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import stft

from diagnostics.signal.cepstrum import cepstrum_at, without_lines
from diagnostics.signal.spectral_kurtosis import spectral_kurtosis
from siggen.errors import UsageError


def test_echo_gives_half_its_share_at_its_delay() -> None:
    # log|1 + a exp(-jw tau)| = a cos(w tau) - a^2/2 cos(2 w tau) + ..., and a cosine splits into two quefrencies
    impulse = np.zeros(1024)
    impulse[0], impulse[100] = 1.0, 0.4
    cepstrum = cepstrum_at(np.log(np.abs(np.fft.rfft(impulse))), np.arange(512))
    assert cepstrum[100] == pytest.approx(0.2)
    assert cepstrum[200] == pytest.approx(-0.04)
    assert np.argmax(cepstrum[10:]) + 10 == 100


def test_removed_lines_leave_no_rahmonic() -> None:
    log_spectrum = np.zeros(1001)
    log_spectrum[::50] = 5.0
    # a line of log height 5 every 50 of 2000 bins: 5/50 at quefrency 2000/50
    assert cepstrum_at(log_spectrum, np.array([40])) == pytest.approx(0.1)
    np.testing.assert_allclose(without_lines(log_spectrum, 50)[26:], 0.0)


def test_removed_lines_take_the_whole_main_lobe_with_them() -> None:
    log_spectrum = np.linspace(0.0, 1.0, 1001)
    smooth = log_spectrum.copy()
    for line in range(50, 1000, 50):
        log_spectrum[line - 2 : line + 3] += [1.0, 4.0, 5.0, 4.0, 1.0]
    # what lies beside a line is a straight line here, so that nothing of the line is left and nothing else is touched
    np.testing.assert_allclose(without_lines(log_spectrum, 50)[:990], smooth[:990], atol=1e-12)


def test_spectral_kurtosis_of_noise_is_zero_and_of_a_tone_minus_one() -> None:
    rng = np.random.default_rng(2)
    noise = rng.standard_normal(256 * 2000)
    found = spectral_kurtosis(noise, 256)
    frames = 2 * 2000 - 1
    # standard error 2/sqrt(frames) for independent frames; overlap by half costs below a factor 1.2
    assert np.abs(found[2:-2]).max() < 5 * 1.2 * 2 / np.sqrt(frames)
    tone = np.cos(2 * np.pi * 32 / 256 * np.arange(256 * 50))
    assert spectral_kurtosis(tone, 256)[32] == pytest.approx(-1.0)


def test_impulses_raise_it_where_they_ring() -> None:
    rng = np.random.default_rng(3)
    signal = rng.standard_normal(100_000)
    ring = np.exp(-np.arange(200) / 40) * np.cos(2 * np.pi * 0.25 * np.arange(200))
    for start in range(1000, 99_000, 5000):
        signal[start : start + 200] += 6 * ring
    found = spectral_kurtosis(signal, 256)
    assert abs(np.argmax(found) / 256 - 0.25) < 0.02
    assert found.max() > 1.0


def test_spectral_kurtosis_is_that_of_scipys_short_spectra() -> None:
    signal = np.random.default_rng(4).standard_normal(5120)
    _, _, spectra = stft(signal, window="hann", nperseg=512, noverlap=256, boundary=None, padded=False)
    power = np.abs(spectra) ** 2
    np.testing.assert_allclose(spectral_kurtosis(signal), (power**2).mean(1) / power.mean(1) ** 2 - 2, rtol=1e-9)


def test_record_of_too_few_frames_is_refused() -> None:
    with pytest.raises(UsageError, match="need 2304"):
        spectral_kurtosis(np.ones(1000))


@pytest.mark.parametrize("size", [3, 100, 1001, 204_537])
def test_cepstrum_at_a_few_quefrencies_is_that_of_the_transform(size: int) -> None:
    log_spectrum = np.random.default_rng(5).standard_normal(size)
    whole = np.fft.irfft(log_spectrum, n=2 * (size - 1))
    few = np.array([0, 1, size // 2, size - 1, whole.size - 1])
    # both sum rounding errors of 1e-16 of values of order one
    np.testing.assert_allclose(cepstrum_at(log_spectrum, few), whole[few], rtol=1e-12, atol=1e-15)


def test_cepstrum_between_its_steps_is_that_of_the_ripple_it_stands_for() -> None:
    # a ripple a cos(2 pi f tau) of the log spectrum with tau = 40.5 steps: a/2 there, a/2 sinc(1/2) at 40 and 41
    size = 4001
    ripple = 0.6 * np.cos(2 * np.pi * np.arange(size) * 40.5 / (2 * (size - 1)))
    found = cepstrum_at(ripple, np.array([40.5, 40.0, 41.0]))
    # the mirror images of the ripple add 1/(2 pi 81) of it
    np.testing.assert_allclose(found, [0.3, 0.3 * np.sinc(0.5), 0.3 * np.sinc(0.5)], atol=0.3 / (2 * np.pi * 40))
