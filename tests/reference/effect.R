# Reference values for analysis/stats effect, noncentral_t and multiple: run with Rscript, writes effect.csv beside itself.
#   one, paired, average, two: conf, expected (d, g, df, low, high), x, y      limits by uniroot on pt with a noncentrality
#   far: the same for t beyond R's 37.62, on the integral over the chi distribution by integrate()
#   lower: 0, expected (P(T <= t)), t df ncp
#   holm, hochberg, bh: 0, expected, p        p.adjust
#   exclusive: 0, expected, p, set            Shaffer's steps, what can be true found by trying every subset of what is left
set.seed(19810602)
lines <- c()
short <- function(v) { s <- sprintf("%.15g", v); if (is.finite(v) && as.numeric(s) != v) sprintf("%.17g", v) else s }
show <- function(x) paste(vapply(x, short, ""), collapse = " ")
add <- function(what, conf, expected, x, y = c())
  lines <<- c(lines, paste(what, sprintf("%.17g", conf), show(expected), show(x), show(y), sep = ","))
factor_j <- function(df) if (df < 2) NaN else exp(lgamma(df / 2) - lgamma((df - 1) / 2)) / sqrt(df / 2)
# P(T <= t): Phi(t s - ncp) over the density of s = sqrt(chi squared / df), cut where Phi and the density change
integral <- function(t, df, ncp, lower = TRUE) {
  f <- function(s) pnorm(t * s - ncp, lower.tail = lower) * 2 * df * s * dchisq(df * s^2, df)
  ends <- sqrt(c(qchisq(1e-17, df), qchisq(1e-17, df, lower.tail = FALSE)) / df)
  middle <- if (t == 0) 1 else ncp / t
  width <- if (t == 0) 1 else 1 / abs(t)
  cuts <- sort(unique(pmin(ends[2], pmax(ends[1], c(ends, middle + width * c(-8, -4, -2, -1, 0, 1, 2, 4, 8),
                                                    1 + c(-4, -2, -1, 0, 1, 2, 4) / sqrt(2 * df))))))
  sum(sapply(seq_len(length(cuts) - 1), function(i)
    integrate(f, cuts[i], cuts[i + 1], rel.tol = 1e-12, abs.tol = 1e-16, subdivisions = 2000L)$value))
}
limits <- function(t, df, conf, cdf) {
  a <- (1 - conf) / 2
  reach <- 12 * (1 + abs(t) / sqrt(2 * df)) * (if (df < 5) 5 else 1)
  c(uniroot(function(ncp) cdf(t, df, ncp, FALSE) - a, t + c(-reach, reach), tol = 1e-13)$root,
    uniroot(function(ncp) cdf(t, df, ncp, TRUE) - a, t + c(-reach, reach), tol = 1e-13)$root)
}
by_pt <- function(t, df, ncp, lower) suppressWarnings(pt(t, df, ncp, lower.tail = lower))
effect <- function(what, conf, t, df, unit, x, y = c()) {
  near <- abs(t) < 15 # so that no limit comes near 37.62
  l <- limits(t, df, conf, if (near) by_pt else integral) * unit
  add(what, conf, c(t * unit, t * unit * factor_j(df), df, l), x, y)
}
for (i in 1:26) {
  n <- if (i <= 3) i + 1 else sample(3:40, 1)
  conf <- sample(c(0.8, 0.9, 0.95, 0.99), 1)
  x <- if (i %% 2) sample(1:10, n, TRUE) else round(rnorm(n, 5, 2), 2)
  y <- if (i %% 2) pmin(10, pmax(1, x + sample(-3:2, n, TRUE))) else round(x + rnorm(n, 0.5), 2)
  if (i %% 9 == 0) x <- round(1000 + rnorm(n), 2) # far from 0
  z <- round(rnorm(sample(2:25, 1), 5, 3), 1)
  if (sd(x) > 0) { t <- t.test(x); effect("one", conf, t$statistic, n - 1, 1 / sqrt(n), x) }
  if (sd(x - y) > 0) {
    t <- t.test(x, y, paired = TRUE)
    effect("paired", conf, t$statistic, n - 1, 1 / sqrt(n), x, y)
    effect("average", conf, t$statistic, n - 1, sd(x - y) / sqrt(n) / ((sd(x) + sd(y)) / 2), x, y)
  }
  if (sd(x) + sd(z) > 0) {
    t <- t.test(x, z, var.equal = TRUE)
    effect("two", conf, t$statistic, t$parameter, sqrt(1 / n + 1 / length(z)), x, z)
  }
}
for (df in c(1, 2, 3, 7, 10, 50, 400)) for (t in c(-4, -0.5, 0, 1, 3, 12)) for (ncp in c(-3, 0, 0.7, 5, 20))
  add("lower", 0, if (ncp < 0) by_pt(-t, df, -ncp, FALSE) else by_pt(t, df, ncp, TRUE), c(t, df, ncp))
for (df in c(1, 3, 21, 200)) for (ncp in c(40, 100, 1000, 1e5)) for (k in c(-1, 0, 1))
  add("lower", 0, integral(ncp * (1 + k / sqrt(2 * df + ncp^2 / ncp)), df, ncp), c(ncp * (1 + k / sqrt(2 * df + ncp^2 / ncp)), df, ncp))
for (i in 1:40) {
  n <- sample(1:20, 1)
  p <- switch(i %% 4 + 1, runif(n), runif(n)^4, round(runif(n), 1), signif(10^-runif(n, 0, 300), 5))
  if (i %% 5 == 0) p[sample(n, max(1, n %/% 4))] <- NaN
  if (i %% 7 == 0) p[1] <- c(0, 1)[i %% 2 + 1]
  add("holm", 0, p.adjust(p, "holm"), p)
  add("hochberg", 0, p.adjust(p, "hochberg"), p)
  add("bh", 0, p.adjust(p, "BH"), p)
}
exclusive <- function(p, set) {
  out <- rep(NaN, length(p)); left <- which(!is.nan(p)); most <- 0
  while (length(left)) {
    possible <- sapply(0:(2^length(left) - 1), function(b) {
      true <- left[bitwAnd(b, 2^(seq_along(left) - 1)) > 0]
      if (anyDuplicated(set[true])) 0 else length(true)
    })
    i <- left[which.min(p[left])]
    most <- max(most, min(1, max(possible) * p[i])); out[i] <- most
    left <- setdiff(left, i)
  }
  out
}
for (i in 1:40) {
  n <- sample(c(1:8, 10), 1)
  p <- switch(i %% 3 + 1, runif(n), runif(n)^6, round(runif(n)^3, 1))
  if (i %% 5 == 0) p[sample(n, max(1, n %/% 4))] <- NaN
  set <- switch(i %% 4 + 1, (seq_len(n) - 1) %/% 2, sample(n, n, TRUE) - 1, seq_len(n) - 1, rep(0, n))
  add("exclusive", 0, exclusive(p, set), p, set)
}
writeLines(lines, "effect.csv")
