# Profile intervals of slopes where a steep function has a peak between any two levels, for analysis/stats/psychometric_fit: run
# with Rscript, writes psychometric_slope.csv beside itself. 60 single answers, asymptotes fixed, so that a profile is over the
# threshold alone: a grid of 6001 and optimize around its 12 best peaks. The ends are where the profile, on a grid of 150 slopes
# from outside, first comes within qchisq(0.95, 1) / 2 of the maximum, then by bisection.
# Columns: name, family, log, falling, guess_low, guess_high, lapse_low, lapse_high, levels, k, n (by spaces), low, high (NA: open).
set.seed(1994)
F <- list(logistic = function(z) plogis(4 * z), normal = function(z) pnorm(sqrt(2 * pi) * z),
          gumbel = function(z) -expm1(-log(2) * exp(2 * z / log(2))))
G <- list(logistic = function(z) plogis(-4 * z), normal = function(z) pnorm(-sqrt(2 * pi) * z),
          gumbel = function(z) exp(-log(2) * exp(2 * z / log(2))))
num <- function(x) paste(sprintf("%.17g", x), collapse = " ")
fit <- function(name, family, guess, x, k) {
  R <- diff(range(x)); gap <- min(diff(x))
  ll <- function(at, slope) {
    z <- slope * outer(x, at, "-"); f <- F[[family]](z); g <- G[[family]](z)
    yes <- pmax(guess * g + f, 1e-300); no <- pmax((1 - guess) * g, 1e-300)
    colSums(k * log(yes) + (1 - k) * log(no))
  }
  ats <- seq(min(x) - R, max(x) + R, length.out = 6001); h <- ats[2] - ats[1]
  profile <- function(ln_slope) {
    v <- ll(ats, exp(ln_slope)); m <- length(v)
    peaks <- which(v >= c(-Inf, v[-m]) & v >= c(v[-1], -Inf))
    peaks <- peaks[order(-v[peaks])][seq_len(min(12, length(peaks)))]
    max(sapply(peaks, function(i) optimize(ll, ats[i] + c(-h, h), slope = exp(ln_slope), maximum = TRUE, tol = 1e-10)$objective), v)
  }
  low <- log(0.1 / R); high <- log(10 / gap)
  grid <- seq(low, high, length.out = 151)
  v <- sapply(grid, profile)
  top <- which.max(v)
  best <- optimize(profile, grid[c(max(1, top - 1), min(151, top + 1))], maximum = TRUE, tol = 1e-9)$objective
  limit <- max(best, v) - qchisq(0.95, 1) / 2
  inside <- which(v >= limit)
  end <- function(i, outward) if (i + outward < 1 || i + outward > 151) NA else
    exp(uniroot(function(s) profile(s) - limit, sort(grid[c(i, i + outward)]), tol = 1e-9)$root)
  paste(c(name, family, 0, 0, num(guess), num(guess), 0, 0, num(x), num(k), num(rep(1, 60)), num(end(min(inside), -1)),
          num(end(max(inside), 1))), collapse = ",")
}
rows <- character(0)
for (family in names(F)) for (i in 1:4) {
  x <- sort(round(runif(60, 0.1, 2), 4))
  while (min(diff(x)) < 0.0015) x <- sort(round(runif(60, 0.1, 2), 4))
  guess <- if (i %% 2) 0.5 else 0
  k <- rbinom(60, 1, guess + (1 - guess) * F[[family]](c(4, 3, 10, 6)[i] * (x - runif(1, 0.6, 1.2))))
  rows <- c(rows, fit(paste("single", i), family, guess, x, k))
}
writeLines(c("name,family,log,falling,guess_low,guess_high,lapse_low,lapse_high,levels,k,n,low,high", rows), "psychometric_slope.csv")
