#!/usr/bin/env python3
# Reference values for analysis/stats/binomial and its neighbours, by integers of 256 bits and mpmath at 80 digits: run
# with python3 (and mpmath), writes binomial_exact.csv beside itself. Nothing of it is our method: tails are the series
# I_x(a, b) = x^a (1-x)^b / (a B(a, b)) (1 + (a+b)/(a+1) x + (a+b)(a+b+1)/((a+1)(a+2)) x^2 + ...), Abramowitz & Stegun
# 26.5.4, or, where a and b are large, I_x(a, b) = x^a (1-x)^(b-1) / (a B(a, b)) (1 + (b-1)/(a+1) x/(1-x) + ...), 26.5.15 repeated,
# long before its terms end; all terms are positive and summed to 2^-140; quantiles are its roots; edges are found by exact probabilities.
# p0, conf and the limits of an equivalence test are the doubles themselves. `ln_` columns are natural logarithms.
#   Two-sided: R's rule (binom.test 4.2): k and beyond, and on the other side of n p0 (a double,
#   as there) all j with P(j) <= P(k) (1 + 1e-7).
#   mid_two: P(j) < P(k) / (1 + 1e-7) whole, those within 1e-7 of P(k) half.
#   equal: two one-sided tests of p0 - margin and p0 + margin, the larger p.
#   bf: ln BF10 for beta priors (1, 1), (1/2, 1/2), (2, 7).
from fractions import Fraction
import math
import mpmath
from mpmath import mp, mpf

mp.dps = 80
BITS = 256
ONE = 1 << BITS
TIE = Fraction(1 + 1e-7)


def real(x):
    return mpf(x.numerator) / mpf(x.denominator)


def fixed(x):
    return int(mpmath.floor(mpmath.ldexp(x, BITS)))


def series(a, b, x):  # a, b Fractions, x in (0, 1) as mpf, at or below the mean, where it converges soon
    X, A, S = fixed(x), 2 * a, 2 * (a + b)  # halves become whole numbers
    A, S, term, total, j = int(A), int(S), ONE, ONE, 0
    while term >> 116:
        term = term * (S + 2 * j) // (A + 2 + 2 * j) * X >> BITS
        total += term
        j += 1
    return mpmath.ldexp(mpf(total), -BITS)


def series_large(a, b, x):
    X, A, B, term, total, j = fixed(x / (1 - x)), int(2 * a), int(2 * b), ONE, ONE, 0
    while term >> 116:
        j += 1
        term = term * (B - 2 * j) // (A + 2 * j) * X >> BITS
        total += term
    assert b.denominator == 1 or j < b / 2
    return mpmath.ldexp(mpf(total), -BITS)


def ln_beta_function(a, b):
    return mpmath.loggamma(a) + mpmath.loggamma(b) - mpmath.loggamma(a + b)


def ln_near(a, b, x):
    a_, b_ = real(a), real(b)
    large = min(a, b) > 10000
    ln_sum = mpmath.log(series_large(a, b, x) / (1 - x) if large else series(a, b, x))
    return a_ * mpmath.log(x) + b_ * mpmath.log1p(-x) - mpmath.log(a_) - ln_beta_function(a_, b_) + ln_sum


def ln_uneven(a, b, x):  # the same as ln_both for a small and b huge
    if a.denominator == 1:  # the other series ends
        high = real(b) * mpmath.log1p(-x) + (real(a) - 1) * mpmath.log(x) - mpmath.log(real(b)) - ln_beta_function(
            real(a), real(b)) + mpmath.log(series_large(b, a, 1 - x))
        return (ln_near(a, b, x) if real(b) * x < 10 * real(a + 10) else mpmath.log1p(-mpmath.exp(high))), high
    low = ln_near(a, b, x)
    high = mpmath.log1p(-mpmath.exp(low))
    assert high > -70  # 30 of 80 digits
    return low, high


def ln_both(a, b, x):  # ln I_x(a, b) and ln of its complement
    a, b = Fraction(a), Fraction(b)
    if x <= 0 or x >= 1:
        return (mpf("-inf"), mpf(0)) if x <= 0 else (mpf(0), mpf("-inf"))
    if max(a, b) > 10**6 and min(a, b) < 10000:
        return ln_uneven(a, b, x) if a < b else ln_uneven(b, a, 1 - x)[::-1]
    if x <= real(a / (a + b)):
        low = ln_near(a, b, x)
        return low, mpmath.log1p(-mpmath.exp(low))
    high = ln_near(b, a, 1 - x)
    return mpmath.log1p(-mpmath.exp(high)), high


def ln_less(k, n, p):  # P(K <= k)
    if k < 0:
        return mpf("-inf")
    return mpf(0) if k >= n else ln_both(k + 1, n - k, real(p))[1]


def ln_greater(k, n, p):  # P(K >= k)
    if k > n:
        return mpf("-inf")
    return mpf(0) if k <= 0 else ln_both(k, n - k + 1, real(p))[0]


def ln_mass(k, n, p):
    if p == 0 or p == 1:
        return mpf(0) if k == (0 if p == 0 else n) else mpf("-inf")
    p_, k_, n_ = real(p), mpf(k), mpf(n)
    return (mpmath.loggamma(n_ + 1) - mpmath.loggamma(k_ + 1) - mpmath.loggamma(n_ - k_ + 1) + k_ * mpmath.log(p_) +
            (n_ - k_) * mpmath.log1p(-p_))


def first(low, high, true):  # least j in low..high for which true(j), high where none below
    while low < high:
        middle = (low + high) // 2
        if true(middle):
            high = middle
        else:
            low = middle + 1
    return low


def edges(k, n, p, factor):  # j below the first and from the second on have P(j) <= P(k) factor
    limit = ln_mass(k, n, p) + mpmath.log(real(factor))
    expected = float(n) * float(p)  # as R has it
    low = first(0, math.floor(expected) + 1, lambda j: ln_mass(j, n, p) > limit)
    high = first(math.ceil(expected), n + 1, lambda j: ln_mass(j, n, p) <= limit)
    return low, high


def ln_add(a, b):
    a, b = max(a, b), min(a, b)
    return a if b == mpf("-inf") else a + mpmath.log1p(mpmath.exp(b - a))


def ln_two(k, n, p):
    if p == 0 or p == 1:
        return mpf(0) if k == (0 if p == 0 else n) else mpf("-inf")
    expected = float(n) * float(p)  # R asks k == n p0 in doubles
    if k == expected:
        return mpf(0)
    low, high = edges(k, n, p, TIE)
    both = (ln_less(k, n, p), ln_greater(high, n, p)) if k < expected else (ln_less(low - 1, n, p), ln_greater(k, n, p))
    return min(mpf(0), ln_add(*both))


def ln_mid_two(k, n, p):
    if p == 0 or p == 1:  # one count has all, and halves itself
        return mpmath.log(mpf(1) / 2) if k == (0 if p == 0 else n) else mpf("-inf")
    parts = []
    for factor in (TIE, 1 / TIE):
        low, high = edges(k, n, p, factor)
        parts.append(mpf(0) if low >= high else min(mpf(0), ln_add(ln_less(low - 1, n, p), ln_greater(high, n, p))))
    return ln_add(*parts) - mpmath.log(2)


def ln_mid_one(k, n, p, less):
    mass = ln_mass(k, n, p) - mpmath.log(2)
    return ln_add(ln_less(k - 1, n, p) if less else ln_greater(k + 1, n, p), mass)


def quantile(a, b, ln_p, upper):  # x with ln I_x(a, b) = ln_p, or its complement where upper: bracketed Newton
    a, b = Fraction(a), Fraction(b)
    low, high, x = mpf(0), mpf(1), real(a / (a + b))
    sd = mpmath.sqrt(x * (1 - x) / real(a + b + 1))
    near = x + (1 if upper else -1) * sd * mpmath.sqrt(2) * mpmath.erfinv(1 - 2 * mpmath.exp(ln_p))
    x = near if x / 2 < near < (1 + x) / 2 else x
    for i in range(200):
        off = ln_both(a, b, x)[1 if upper else 0] - ln_p
        if (off > 0) != upper:
            high = x
        else:
            low = x
        ln_density = (real(a) - 1) * mpmath.log(x) + (real(b) - 1) * mpmath.log1p(-x) - ln_beta_function(real(a), real(b))
        slope = mpmath.exp(ln_density - (off + ln_p)) * (-1 if upper else 1)
        step = off / slope
        if i < 40:  # a tail's logarithm bends: no wide jumps
            step = max(-3 * sd, min(3 * sd, step))
        new = x - step
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - x) < x * mpf(10)**-12 and abs(new - x) < sd * mpf(10)**-12:  # its square is left
            return new
        x = new
    raise ArithmeticError("no root")


def beta_interval(low_of, high_of, k, n, tail):
    ln_tail = mpmath.log(tail)
    return (mpf(0) if k == 0 else quantile(*low_of, ln_tail, False), mpf(1) if k == n else quantile(*high_of, ln_tail, True))


def wilson(k, n, tail):
    z = mpmath.sqrt(2) * mpmath.erfinv(1 - 2 * tail)
    n_, e = mpf(n), mpf(k) / n
    half = z * mpmath.sqrt(e * (1 - e) / n_ + z * z / (4 * n_ * n_))
    low, high = (e + z * z / (2 * n_) - half) / (1 + z * z / n_), (e + z * z / (2 * n_) + half) / (1 + z * z / n_)
    return mpf(0) if k == 0 else low, mpf(1) if k == n else high


def bayes_factor(k, n, p, a, b):
    a, b, p_ = mpf(a), mpf(b), real(p)
    against = mpf(0)
    for count, share in ((k, p_), (n - k, 1 - p_)):
        if count:
            against += count * mpmath.log(share) if share > 0 else mpf("-inf")
    return ln_beta_function(k + a, n - k + b) - ln_beta_function(a, b) - against


def equal(k, n, p0, margin):
    low, high = p0 - margin, p0 + margin
    if not (margin > 0 and low >= 0 and high <= 1):
        return mpf("nan")
    return max(ln_greater(k, n, Fraction(low)), ln_less(k, n, Fraction(high)))


def row(k, n, p0, conf, margin):
    p, tail = Fraction(p0), real(Fraction(1) - Fraction(conf))
    out = [ln_two(k, n, p), ln_less(k, n, p), ln_greater(k, n, p), ln_mid_two(k, n, p), ln_mid_one(k, n, p, True),
           ln_mid_one(k, n, p, False), equal(k, n, p0, margin)]
    half = Fraction(1, 2)
    for t in (tail / 2, tail):
        out += beta_interval((k, n - k + 1), (k + 1, n - k), k, n, t)
        out += wilson(k, n, t)
        out += beta_interval((k + half, n - k + half), (k + half, n - k + half), k, n, t)
    for a, b in ((1, 1), (0.5, 0.5), (2, 7)):
        out.append(bayes_factor(k, n, p, a, b))
    return out


cases = []


def add(k, n, p0, conf=0.95, margin=0.1):
    if (k, n, p0, conf, margin) not in cases:
        cases.append((k, n, p0, conf, margin))


for n in (1, 2, 5, 22, 43):
    for k in sorted({0, 1, n // 4, n // 2, n - 1, n}):
        add(k, n, 0.5)
for k in range(23):
    add(k, 22, 0.5, 0.9, 0.2)
for k, n in ((0, 12), (3, 12), (12, 12)):
    for p0 in (0.0, 1.0, 0.1, 1 / 3, 0.75, 1e-6):
        add(k, n, p0, 0.99, 0.05)
for n, p0 in ((150, 0.3), (1000, 0.5), (1000, 0.02), (4321, 0.9), (10000, 0.5), (10000, 0.61), (100000, 0.001)):
    sd = (n * p0 * (1 - p0))**0.5
    for z in (-36, -12, -5, -2, -0.3, 0.3, 2, 5, 12, 36):
        k = round(n * p0 + z * sd)
        if 0 <= k <= n:
            add(k, n, p0, 0.95 if abs(z) < 3 else 0.999, 0.01)
add(0, 990, 0.5)  # 2^-990: near 1e-298
add(0, 10000, 0.5)
add(9999, 10000, 0.5)
add(3, 10000, 0.01)
for n, p0 in ((10**6, 0.5), (10**6, 0.07), (10**9, 0.5), (10**9, 0.3), (10**9, 1e-8), (10**9, 0.999)):
    sd = (n * p0 * (1 - p0))**0.5
    for z in (-37, -6, -1, 0.001, 1.7, 37):
        k = round(n * p0 + z * sd)
        if 0 <= k <= n:
            add(k, n, p0, 0.95, 0.0001)
for k in (0, 1, 10**9):
    add(k, 10**9, 0.5)
    add(k, 10**9, 1e-9)

names = ["two", "less", "greater", "mid_two", "mid_less", "mid_greater", "equal"]
header = ["k", "n", "p0", "conf", "margin"] + ["ln_" + name for name in names]
for sides in ("", "one_"):
    for name in ("clopper", "wilson", "jeffreys"):
        header += [sides + name + "_low", sides + name + "_high"]
header += ["ln_bf_1_1", "ln_bf_half_half", "ln_bf_2_7"]
if __name__ == "__main__":
    with open(__file__.rsplit("/", 1)[0] + "/binomial_exact.csv" if "/" in __file__ else "binomial_exact.csv", "w") as file:
        file.write(",".join(header) + "\n")
        for case in cases:
            values = [mpmath.nstr(v, 20) if mpmath.isfinite(v) else {"+inf": "inf", "-inf": "-inf", "nan": "NaN"}[str(v)]
                      for v in row(*case)]
            file.write("%d,%d,%.17g,%.17g,%.17g," % case + ",".join(values) + "\n")
            file.flush()
