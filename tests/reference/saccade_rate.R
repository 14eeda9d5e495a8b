# How far the peak velocity of saccades, and a main sequence fitted to it, are off at a tracker's rate: writes
# saccade_rate.csv beside itself. Base R only.
# Each line: vmax and c of the simulated people, profile, noise (degrees, SD), rate in Hz, window of the peak in ms, the
# time that a peak's velocity is taken over in ms, then found / true of vmax, c, and of k and b (of V = k A^b, against the
# same fit to the true peaks), saccades found.
# 600 saccades of 1 to 18 degrees per line, their phase against the samples random; velocity profiles a raised cosine and a
# minimum jerk. Found as I-VT does: faster than 30 deg/s over 20 ms, for at least 10 ms; vmax and c by least squares.
out <- file(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "saccade_rate.csv"), "w")
set.seed(20162)

profiles <- list(cosine = list(at = function(u) u - sin(2 * pi * u) / (2 * pi), peak = 2),
                 jerk = list(at = function(u) 10 * u^3 - 15 * u^4 + 6 * u^5, peak = 1.875))
steps <- function(window, hz) max(1, floor(window / 2000 * hz + 1e-9))
velocity <- function(x, k, hz) {
  n <- length(x); from <- pmax(1, seq_len(n) - k); to <- pmin(n, seq_len(n) + k)
  abs(x[to] - x[from]) / (to - from) * hz
}
saccade <- function(a, truth, p, hz, window, noise) {
  d <- p$peak * a / (truth[1] * (1 - exp(-a / truth[2])))
  t <- seq(-0.2 + runif(1) / hz, d + 0.2, by = 1 / hz)
  x <- a * p$at(pmin(pmax(t / d, 0), 1)) + rnorm(length(t), 0, noise)
  v <- velocity(x, steps(20, hz), hz)
  first <- last <- which.max(v)
  while (first > 1 && v[first - 1] > 30) first <- first - 1
  while (last < length(v) && v[last + 1] > 30) last <- last + 1
  if (max(v) <= 30 || (last - first) / hz < 0.010 - 1e-9) return(c(NA, NA))
  c(abs(x[last] - x[first]), max(velocity(x, steps(window, hz), hz)[first:last]))
}
exponential <- function(a, v) {
  vmax <- function(c) { f <- 1 - exp(-a / c); sum(v * f) / sum(f^2) }
  c <- exp(optimize(function(l) sum((v - vmax(exp(l)) * (1 - exp(-a / exp(l))))^2), log(c(0.5, 100)), tol = 1e-9)$minimum)
  c(vmax(c), c)
}
power <- function(a, v) { p <- coef(lm(log(v) ~ log(a))); c(exp(p[[1]]), p[[2]]) }

cases <- list(c(60, 8), c(75, 8), c(90, 8), c(100, 8), c(115, 8), c(120, 8), c(200, 8), c(236, 8), c(250, 8), c(500, 8), c(1000, 8),
              c(250, 20), c(1000, 20))
for (name in names(profiles)) for (truth in list(c(400, 4), c(500, 6), c(600, 6), c(700, 7))) for (noise in c(0.03, 0.1)) for (case in cases) {
  a <- runif(600, 1, 18)
  s <- sapply(a, saccade, truth, profiles[[name]], case[1], case[2], noise)
  ok <- !is.na(s[1, ])
  ratio <- c(exponential(s[1, ok], s[2, ok]) / truth,
             power(s[1, ok], s[2, ok]) / power(a[ok], truth[1] * (1 - exp(-a[ok] / truth[2]))))
  writeLines(paste(c(truth, name, noise, case, sprintf("%.6g", 2000 * steps(case[2], case[1]) / case[1]),
                     sprintf("%.4f", ratio), sum(ok)), collapse = ","), out)
}
close(out)
