"""Detectors are judged on gearboxes that they were not shown; ridge against refits; chance against its own law."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.audit.bank import DESIGN, bank_maxima, exchanged_unit, permuted
from diagnostics.judging.evaluation import held_out, held_out_values, judged_rows, rounds
from diagnostics.judging.learners import PENALTIES, BestColumn, GroupRidge, all_columns, best_column, products

GEARBOXES, COLUMNS = 16, 60


def design(gearboxes: int = GEARBOXES) -> tuple[np.ndarray, np.ndarray]:
    """Three records a gearbox, the last one damaged."""
    return np.repeat(np.arange(gearboxes), 3), np.tile([False, False, True], gearboxes)


def noise(seed: int, columns: int = COLUMNS) -> np.ndarray:
    """Columns of records with an offset of their gearbox."""
    rng, specimen = np.random.default_rng(seed), design()[0]
    return rng.standard_normal((GEARBOXES, columns))[specimen] + rng.standard_normal((specimen.size, columns))


def names(count: int = COLUMNS) -> tuple[str, ...]:
    return tuple(f"column {k}" for k in range(count))


def test_a_fold_holds_whole_gearboxes_and_both_sides_hold_both_classes() -> None:
    specimen, damaged = design()
    folds = DESIGN.dealt(specimen, 1)
    for fold in folds:
        assert all(np.unique(fold[specimen == owner]).size == 1 for owner in range(GEARBOXES))
        assert np.unique(fold).size == 4
    entry, every = best_column("best", noise(1), names()), np.arange(specimen.size)
    asked = [own for _, own, _ in rounds(entry, every, damaged[None], specimen, folds)]
    assert len(asked) == 12
    assert all(not set(specimen[own]) & set(specimen[~own]) for own in asked)


def test_the_best_of_many_empty_columns_is_at_chance_on_unseen_gearboxes_only() -> None:
    specimen, damaged = design()
    folds, every = DESIGN.dealt(specimen, 0), np.arange(specimen.size)
    area, shown = [], []
    for seed in range(30):
        values = noise(seed)
        for detector in (best_column("best", values, names()), all_columns("all", values)):
            area.append(held_out(detector, every, damaged, specimen, folds, 0).auc.value)
        told = BestColumn(names()).fit(values, damaged, specimen).score(values)
        shown.append(np.mean(told[damaged][:, None] > told[~damaged]))
    # spread of one AUC 0.1, of the mean over 60 about 0.015
    assert np.mean(area) == pytest.approx(0.5, abs=0.05)
    # what a choice on the judged gearboxes would have claimed
    assert np.mean(shown) > np.mean(area) + 0.1


def test_a_planted_column_is_chosen_and_named_and_too_few_gearboxes_are_not_judged() -> None:
    specimen, damaged = design()
    values = noise(3)
    values[:, 7] -= 4.0 * damaged
    detector = best_column("best", values, names())
    found = held_out(detector, np.arange(specimen.size), damaged, specimen, DESIGN.dealt(specimen, 0), 0)
    assert found.basis == "column 7"
    assert found.auc.value > 0.95
    assert found.auc.low == pytest.approx(0.025 ** (1 / 16))  # Clopper and Pearson: no surer than all 16 of 16 right
    assert judged_rows(detector, ~damaged, damaged, specimen).size == specimen.size
    few = damaged & (specimen < 3)
    assert judged_rows(detector, ~damaged, few, specimen).size == 0


def test_the_dual_form_is_ridge_regression_and_its_penalty_the_one_of_refits_without_each_gearbox() -> None:
    from sklearn.linear_model import Ridge

    specimen, damaged = design()
    values = noise(5, 8) + 0.8 * damaged[:, None]
    train = specimen < 12
    scaled = (values - values.mean(axis=0)) / values.std(axis=0) / np.sqrt(values.shape[1])
    inner = scaled[train] - scaled[train].mean(axis=0)
    scale = float(np.square(inner).sum() / train.sum())
    target = np.where(damaged, 1.0, 0.0)

    def refitted(penalty: float) -> float:
        error = 0.0
        for owner in range(12):
            rest, out = train & (specimen != owner), specimen == owner
            # the closed form keeps the mean of the columns, the refit moves it: both fit the mean of the target
            model = Ridge(penalty * scale).fit(scaled[rest], target[rest])
            error += float(np.square(target[out] - model.predict(scaled[out])).sum())
        return error

    best = min(PENALTIES, key=refitted)
    expected = Ridge(best * scale).fit(scaled[train], target[train]).predict(scaled[~train])
    turned = permuted(damaged, specimen, specimen, 0, 1)
    ways, every = np.concatenate([turned, damaged[None]]), np.arange(specimen.size)
    model = GroupRidge(products(values)).fit(every[train], ways[:, train], specimen[train])
    found = model.score(every[~train])[1]
    assert found + target[train].mean() == pytest.approx(expected, abs=1e-8)


def test_with_one_gearbox_to_learn_from_the_largest_penalty_stands() -> None:
    """Its two records differ in one direction only, so a penalty scales the scores and leaves their order."""
    values = np.random.default_rng(5).normal(size=(6, 3))
    train, damaged = np.arange(6) < 2, np.array([[True, False, True, False, True, False]])
    found = GroupRidge(products(values)).fit(np.arange(2), damaged[:, train], np.zeros(2)).score(np.arange(2, 6))[0]
    scaled = (values - values.mean(axis=0)) / values.std(axis=0)
    assert np.isfinite(found).all()
    expected = (scaled[2:] - scaled[:2].mean(axis=0)) @ (scaled[0] - scaled[1])
    assert found / np.abs(found).max() == pytest.approx(expected / np.abs(expected).max(), abs=1e-9)


def test_states_are_permuted_within_gearboxes_and_a_true_effect_exceeds_what_chance_reaches() -> None:
    specimen, damaged = design()
    turned = permuted(damaged, specimen, specimen, 0, 1)[0]
    assert np.array_equal(np.bincount(specimen, turned), np.ones(GEARBOXES))
    assert not np.array_equal(turned, damaged)
    one_state_each = specimen >= 8
    among = permuted(one_state_each, specimen, specimen, 0, 1)[0]
    assert among.sum() == one_state_each.sum()
    assert all(np.unique(among[specimen == owner]).size == 1 for owner in range(GEARBOXES))
    assert exchanged_unit(damaged, np.arange(specimen.size), specimen) == "gearbox"
    assert exchanged_unit(one_state_each, specimen, specimen) == "gearboxes"
    folds, every, values = DESIGN.dealt(specimen, 0), np.arange(specimen.size), noise(9)
    bank = [best_column("best", values, names()), all_columns("all", values)]
    maxima = bank_maxima(bank, every, permuted(damaged, specimen, specimen, 0, 20), specimen, folds)
    assert 0.5 < np.quantile(maxima, 0.95) < 0.85
    planted = best_column("best", values - 4.0 * damaged[:, None], names())
    assert held_out(planted, every, damaged, specimen, folds, 0).auc.value > max(maxima)


def test_what_stands_alone_in_its_block_keeps_its_state() -> None:
    specimen, damaged = design()
    block = np.where(np.arange(specimen.size) % 3 == 0, specimen, GEARBOXES + specimen)
    assert exchanged_unit(damaged, block, specimen) == "block"
    turned = permuted(damaged, block, specimen, 0, 40)
    assert not turned[:, ::3].any()
    assert np.all(turned.reshape(40, GEARBOXES, 3).sum(axis=2) == 1)
    # 16 gearboxes, 40 permutations: half of 640 within four standard deviations
    assert turned[:, 1::3].sum() == pytest.approx(320, abs=51)


def test_many_ways_of_stating_the_damage_give_what_each_gives_alone() -> None:
    specimen, damaged = design(7)  # folds of unequal size
    values = np.random.default_rng(4).integers(0, 9, (specimen.size, 12)).astype(float)  # with ties
    values += np.random.default_rng(5).standard_normal(12) * 3.0
    rows, folds = np.arange(specimen.size), DESIGN.dealt(specimen, 0)
    ways = np.concatenate([damaged[None], permuted(damaged, specimen, specimen, 0, 9)])
    for detector in (best_column("best", values, names(12)), all_columns("all", values)):
        together = held_out_values(detector, rows, ways, specimen, folds)
        alone = [held_out(detector, rows, way, specimen, folds, 0).auc.value for way in ways]
        assert together == pytest.approx(np.array(alone), abs=1e-12)
