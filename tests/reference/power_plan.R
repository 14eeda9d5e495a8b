# Reference values for analysis/stats/power_equivalence, power_anova and the sizes of `fovstats power`: run with Rscript,
# writes power_plan.csv beside itself. Columns: what, n, cells, df, x, sd, margin, alpha, power, value, error (the
# simulation's standard error, 0 where there is none).
#   equivalence          n choices, x the true share: every k tried with two one-sided binom.test
#   equivalence_first, equivalence_stays   the same, people for `power` among the first n sizes; 0 where one of the first
#                        1.5 n has not the power though all from `stays` to n have it: a claim on those beyond n would be false
#   equivalence_many     n people with `cells` choices each: 20,000 simulated studies, two one-sided t.test of the shares
#   anova                n people, x is f: mean over the error's chi-squared of a noncentral chi-squared, by integrate()
#   anova_aov            the same by 4,000 simulated studies through aov() with Error(), two factors of 3 and 2 levels
#   anova_size           people for `power`, x is f: the first size that has it by the integral
#   none, none_margin    n people of whom the 3rd and the 22nd of each 22 make no choice, the others one, x the true share:
#                        every count of the choices tried with binom.test; _first, _stays: people for `power`, of 120 sizes
#   part                 n participants of whom only `df` of `cells` are in the cell and choose once (the whole number of
#                        people nearest to that, of two the smaller), x the true share: every count tried with binom.test;
#                        _first, _stays: participants for `power`, of n sizes
#   paired_size, two_size   people for `power`, x is d: power.t.test(strict = TRUE) for each size in turn, and pt with a
#                        noncentrality for halves of odd numbers
set.seed(20261126)
rows <- list()
add <- function(what, n, cells, df, x, sd, margin, alpha, power, value, error = 0)
  rows[[length(rows) + 1]] <<- sprintf("%s,%d,%d,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", what, as.integer(n),
                                       as.integer(cells), as.integer(df), x, sd, margin, alpha, power, value, error)

shown <- function(n, margin, alpha) (0:n)[sapply(0:n, function(k)
  binom.test(k, n, 0.5 - margin, "greater")$p.value <= alpha && binom.test(k, n, 0.5 + margin, "less")$p.value <= alpha)]
equivalence <- function(n, margin, share, alpha) sum(dbinom(shown(n, margin, alpha), n, share))
for (n in c(1, 5, 12, 19, 22, 40, 75, 120, 250))
  for (margin in c(0.1, 0.2, 0.35, 0.5))
    for (alpha in c(0.01, 0.05))
      for (share in c(0.3, 0.5, 0.55))
        add("equivalence", n, 1, 0, share, 0, margin, alpha, NA, equivalence(n, margin, share, alpha))
for (design in list(c(0.2, 0.5, 0.05, 0.8), c(0.15, 0.5, 0.05, 0.9), c(0.25, 0.55, 0.025, 0.8), c(0.05, 0.5, 0.05, 0.8))) {
  reached <- sapply(1:400, function(n) equivalence(n, design[1], design[2], design[3])) >= design[4]
  last <- max(c(0, which(!reached)))
  ok <- last < 400
  add("equivalence_first", 400, 1, 0, design[2], 0, design[1], design[3], design[4], if (ok) which(reached)[1] else 0)
  add("equivalence_stays", 400, 1, 0, design[2], 0, design[1], design[3], design[4], if (ok) last + 1 else 0)
}

intercept <- function(share, sd) if (sd == 0) qlogis(share) else
  uniroot(function(b) integrate(function(z) plogis(b + sd * z) * dnorm(z), -Inf, Inf, rel.tol = 1e-11)$value - share,
          c(-30, 30), tol = 1e-12)$root
for (design in list(c(20, 20, 0.5, 0.5, 0.1), c(12, 9, 0.5, 1, 0.2), c(24, 40, 0.55, 0.5, 0.1), c(16, 6, 0.5, 0, 0.1))) {
  b <- intercept(design[3], design[4])
  found <- replicate(20000, {
    share <- rbinom(design[1], design[2], plogis(b + design[4] * rnorm(design[1]))) / design[2]
    sd(share) > 0 && t.test(share, mu = 0.5 - design[5], alternative = "greater")$p.value <= 0.05 &&
      t.test(share, mu = 0.5 + design[5], alternative = "less")$p.value <= 0.05
  })
  add("equivalence_many", design[1], design[2], 0, design[3], design[4], design[5], 0.05, NA, mean(found),
      sqrt(mean(found) * (1 - mean(found)) / 20000))
}

# Over the logarithm of the chi-squared, in 80 panels: with one degree of freedom all that matters may lie near 0.
upper_f <- function(q, df, df_error, ncp) {
  at <- function(s) dchisq(exp(s), df_error) * exp(s) * pchisq(df * q * exp(s) / df_error, df, ncp, lower.tail = FALSE)
  ends <- seq(log(qchisq(1e-20, df_error)), log(qchisq(1e-20, df_error, lower.tail = FALSE)), length.out = 81)
  sum(sapply(1:80, function(i) integrate(at, ends[i], ends[i + 1], rel.tol = 1e-10, abs.tol = 1e-15)$value))
}
anova_power <- function(n, cells, df, f, alpha)
  upper_f(qf(alpha, df, df * (n - 1), lower.tail = FALSE), df, df * (n - 1), n * cells * f^2)
for (n in c(2, 3, 8, 15, 22, 60, 200))
  for (design in list(c(2, 1), c(3, 2), c(6, 2), c(6, 1), c(12, 6), c(24, 5)))
    for (f in c(0.05, 0.1, 0.25, 0.4))
      for (alpha in c(0.01, 0.05))
        add("anova", n, design[1], design[2], f, 0, 0, alpha, NA, anova_power(n, design[1], design[2], f, alpha))

# An effect of the factor of three levels with f = 0.3 of its error: the error of factor a by people is that of a cell.
simulated <- function(n, f, studies = 4000) {
  effect <- c(-1, 0, 1); effect <- f * effect / sqrt(mean(effect^2))
  d <- expand.grid(a = factor(1:3), b = factor(1:2), person = factor(1:n))
  found <- replicate(studies, {
    d$y <- rnorm(n, sd = 2)[d$person] + effect[d$a] + rnorm(nrow(d))
    summary(aov(y ~ a * b + Error(person / (a * b)), d))[["Error: person:a"]][[1]][["Pr(>F)"]][1] <= 0.05
  })
  add("anova_aov", n, 6, 2, f, 0, 0, 0.05, NA, mean(found), sqrt(mean(found) * (1 - mean(found)) / studies))
}
simulated(10, 0.3)
simulated(16, 0.3)

two_power <- function(n, m, d, alpha) {
  df <- n + m - 2; ncp <- d * sqrt(n * m / (n + m)); limit <- qt(alpha / 2, df, lower.tail = FALSE)
  pt(limit, df, ncp, lower.tail = FALSE) + pt(-limit, df, ncp)
}
for (d in c(0.3, 0.5, 0.8, 1.5))
  for (power in c(0.8, 0.95)) {
    n <- 2
    while (power.t.test(n, d, 1, 0.05, type = "paired", strict = TRUE)$power < power) n <- n + 1
    add("paired_size", 0, 0, 0, d, 0, 0, 0.05, power, n)
    n <- 4
    while (two_power(ceiling(n / 2), floor(n / 2), d, 0.05) < power) n <- n + 1
    add("two_size", 0, 0, 0, d, 0, 0, 0.05, power, n)
  }

# The end of the search: sizes up to which all from some size on have the power, and one beyond has not.
for (design in list(c(0.2, 0.5, 0.05, 0.8), c(0.15, 0.5, 0.05, 0.9), c(0.25, 0.55, 0.025, 0.8))) {
  reached <- sapply(1:200, function(n) equivalence(n, design[1], design[2], design[3])) >= design[4]
  truth <- max(which(!reached)) + 1
  stopifnot(truth < 133)
  false <- Filter(function(most) reached[most] && max(which(!reached[1:most])) + 1 != truth, 20:truth)
  stopifnot(length(false) > 1)
  for (most in false) {
    add("equivalence_first", most, 1, 0, design[2], 0, design[1], design[3], design[4], 0)
    add("equivalence_stays", most, 1, 0, design[2], 0, design[1], design[3], design[4], 0)
  }
  most <- ceiling(1.2 * truth)
  add("equivalence_first", most, 1, 0, design[2], 0, design[1], design[3], design[4], which(reached)[1])
  add("equivalence_stays", most, 1, 0, design[2], 0, design[1], design[3], design[4], truth)
}

for (design in list(c(6, 2, 0.25), c(6, 1, 0.25), c(24, 6, 0.15), c(24, 1, 0.15)))
  for (power in c(0.8, 0.95)) {
    n <- 2
    while (anova_power(n, design[1], design[2], design[3], 0.05) < power) n <- n + 1
    add("anova_size", 0, design[1], design[2], design[3], 0, 0, 0.05, power, n)
  }

one_or_none <- replace(rep(1, 22), c(3, 22), 0)
choices_of <- function(people) sum(rep(one_or_none, length.out = people))
difference <- function(n, share, alpha) sum(dbinom(Filter(function(k) binom.test(k, n)$p.value <= alpha, 0:n), n, share))
for (kind in c("none", "none_margin")) {
  share <- if (kind == "none") 0.75 else 0.5
  margin <- if (kind == "none") 0 else 0.2
  power_of <- function(n) if (kind == "none") difference(n, share, 0.05) else equivalence(n, margin, share, 0.05)
  by_choices <- sapply(1:120, power_of)
  of <- sapply(1:120, function(people) by_choices[choices_of(people)])
  for (people in c(2, 3, 20, 22, 25, 44, 50)) add(kind, people, 1, 0, share, 0, margin, 0.05, NA, of[people])
  reached <- of >= 0.8
  add(paste0(kind, "_first"), 120, 1, 0, share, 0, margin, 0.05, 0.8, which(reached)[1])
  add(paste0(kind, "_stays"), 120, 1, 0, share, 0, margin, 0.05, 0.8, max(which(!reached)) + 1)
}
by_people <- sapply(1:120, difference, 0.75, 0.05)
for (part in list(c(9, 22), c(19, 22), c(9, 21))) {
  there <- function(n) (0:n)[which.min(abs(0:n - n * part[1] / part[2]))]
  sizes <- floor(110 * part[2] / part[1])
  of <- sapply(1:sizes, function(n) if (there(n) == 0) 0 else by_people[there(n)])
  for (n in c(1, 2, 11, 22, 23, 44, 100)) add("part", n, part[2], part[1], 0.75, 0, 0, 0.05, NA, of[n])
  add("part_first", sizes, part[2], part[1], 0.75, 0, 0, 0.05, 0.8, which(of >= 0.8)[1])
  add("part_stays", sizes, part[2], part[1], 0.75, 0, 0, 0.05, 0.8, max(which(of < 0.8)) + 1)
}
writeLines(c("what,n,cells,df,x,sd,margin,alpha,power,value,error", unlist(rows)), "power_plan.csv")
