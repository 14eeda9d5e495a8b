#!/usr/bin/env python3
# Reference values for analysis/stats/fisher, 2 x 2: run with python3 (and mpmath), writes fisher.csv beside itself. p by
# whole numbers; odds ratio (conditional maximum likelihood) and interval by roots at 60 digits, where R's fisher.test
# stops at about 1e-4. Columns: a b c d conf alternative p odds low high.
from math import comb
import random
import mpmath
from mpmath import mp, mpf

mp.dps = 60
TIE = 1 + 10**-7 * mpf(1)


def table(a, b, c, d, conf, alternative):
    row, other, column = a + b, c + d, a + c
    low, high = max(0, column - other), min(row, column)
    weights = {x: comb(row, x) * comb(other, column - x) for x in range(low, high + 1)}
    kept = [w for x, w in weights.items()
            if (w <= weights[a] * TIE if alternative == "two.sided" else x <= a if alternative == "less" else x >= a)]
    p = mpf(sum(kept)) / sum(weights.values())
    if low == high:
        return p, mpf("nan"), mpf(0), mpf("inf")

    def share(ln_odds, true):
        at = {x: w * mpmath.exp((x - a) * ln_odds) for x, w in weights.items()}
        return sum(v * true(x) for x, v in at.items()) / sum(at.values())

    def root(true, target):
        rises = share(mpf(1), true) > share(mpf(0), true)
        left, right = mpf(-200), mpf(200)
        for i in range(150):
            middle = (left + right) / 2
            if (share(middle, true) < target) == rises:
                left = middle
            else:
                right = middle
        return mpmath.exp(left)

    tail = (1 - mpf(conf)) / (2 if alternative == "two.sided" else 1)
    odds = mpf(0) if a == low else mpf("inf") if a == high else root(lambda x: x - low, mpf(a - low))
    least, most = mpf(0), mpf("inf")
    if alternative != "less" and a > low:
        least = root(lambda x: x >= a, tail)
    if alternative != "greater" and a < high:
        most = root(lambda x: x <= a, tail)
    return p, odds, least, most


random.seed(20211105)
cases = [(3, 1, 1, 3, 0.95, "greater"), (3, 1, 1, 3, 0.95, "two.sided"), (2, 10, 15, 3, 0.95, "two.sided"),
         (2, 10, 15, 3, 0.95, "less"), (0, 7, 5, 4, 0.95, "two.sided"), (7, 0, 4, 5, 0.95, "two.sided"),
         (0, 5, 0, 6, 0.95, "two.sided"), (0, 0, 3, 4, 0.95, "less"), (1, 0, 0, 1, 0.95, "two.sided"),
         (10, 10, 10, 10, 0.99, "two.sided"), (150, 40, 60, 130, 0.95, "two.sided"), (1, 300, 40, 2, 0.9, "two.sided"),
         (200, 1, 1, 200, 0.95, "two.sided")]
for i in range(25):
    cases.append(tuple(random.randrange(0, random.choice((4, 12, 40))) for j in range(4)) +
                 (random.choice((0.8, 0.95, 0.99)), random.choice(("two.sided", "less", "greater"))))
lines = ["a,b,c,d,conf,alternative,p,odds,low,high"]
for case in cases:
    if sum(case[:4]) > 0:
        values = [{"+inf": "inf", "nan": "NaN"}.get(str(v)) or mpmath.nstr(v, 20) for v in table(*case)]
        lines.append("%d,%d,%d,%d,%.17g,%s," % case + ",".join(values))
open((__file__.rsplit("/", 1)[0] + "/" if "/" in __file__ else "") + "fisher.csv", "w").write("\n".join(lines) + "\n")
