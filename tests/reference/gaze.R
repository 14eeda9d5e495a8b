# Reference values for analysis/gaze and analysis/stats/main_sequence: run with Rscript, writes gaze.csv beside itself.
# Base R only. Each line: what, name, then fields of numbers by spaces.
#   spread: x, y; then n, sd x, sd y, sd both, BCEA at 0.682 (by its formula with sd() and cor()), RMS of steps x, y, both
#   angle: x1 y1 x2 y2 in degrees; the angle by atan2 of cross and dot product
#   eye: x y of a point from the middle between the eyes, its distance, the eye's distance to the right (metres); x y as that
#     eye sees it, by rotating the head so that it looks along x first
#   sequence: amplitudes; velocities; nls() of vmax (1 - exp(-A / c)): vmax, its error, c, its error, residual SD; lm() of
#     logs: ln k, its error, b, its error; t quantile of n - 2 at 95 %
#   ivt, idt: times in ms; x; y; parameters (velocity, window, least fixation, least saccade, merge ms, merge deg, window of
#     the peak; or dispersion, least fixation); then events as kind (1 fixation, 2 saccade), first, last (from 0), amplitude, peak
#     (0 of fixations; NA where the samples are too far apart at it). By the definitions, sample by sample, without a moving window.
out <- file(file.path(dirname(sub("--file=", "", grep("--file=", commandArgs(FALSE), value = TRUE))), "gaze.csv"), "w")
line <- function(...) writeLines(paste(..., sep = ","), out)
num <- function(x) paste(sprintf("%.17g", x), collapse = " ")
set.seed(20161)

unit <- function(x, y) {
  x <- x * pi / 180; y <- y * pi / 180
  c(sin(x) * cos(y), sin(y), -cos(x) * cos(y))
}
angle <- function(x1, y1, x2, y2) {
  a <- unit(x1, y1); b <- unit(x2, y2)
  cross <- c(a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1])
  atan2(sqrt(sum(cross^2)), sum(a * b)) * 180 / pi
}

spread <- function(name, x, y) {
  bcea <- 2 * -log(1 - 0.682) * pi * sd(x) * sd(y) * sqrt(1 - cor(x, y)^2)
  rms <- sqrt(c(mean(diff(x)^2), mean(diff(y)^2), mean(diff(x)^2) + mean(diff(y)^2)))
  line("spread", name, num(x), num(y), num(c(length(x), sd(x), sd(y), sqrt(var(x) + var(y)), bcea, rms)))
}
x <- rnorm(40, 3, 0.2); y <- 0.6 * x + rnorm(40, -2, 0.1)
spread("correlated", x, y)
spread("far off", x + 1e6, y - 1e6)
spread("three", c(1, 2, 4), c(0, 3, 1))
spread("wide", runif(200, -40, 40), runif(200, -40, 40))

for (i in 1:20) {
  p <- runif(4, -60, 60)
  line("angle", paste("random", i), num(p), num(angle(p[1], p[2], p[3], p[4])))
}
line("angle", "tiny", num(c(20, 10, 20 + 1e-7, 10)), num(1e-7 * cos(10 * pi / 180)))
line("angle", "right angle", num(c(-45, 0, 45, 0)), num(90))
line("angle", "opposite", num(c(-90, 0, 90, 0)), num(180))

sequence <- function(name, a, v) {
  fit <- nls(v ~ vmax * (1 - exp(-a / c)), start = list(vmax = max(v), c = median(a)),
             control = nls.control(tol = 1e-7, maxiter = 500, warnOnly = TRUE))
  s <- summary(fit)
  p <- summary(lm(log(v) ~ log(a)))$coefficients
  line("sequence", name, num(a), num(v),
       num(c(s$coefficients[1, 1:2], s$coefficients[2, 1:2], s$sigma, p[1, 1:2], p[2, 1:2],
             qt(0.975, length(a) - 2))))
}
for (i in 1:6) {
  n <- c(10, 20, 60, 200, 60, 30)[i]
  a <- exp(runif(n, log(0.5), log(c(20, 25, 30, 25, 12, 40)[i])))
  v <- c(600, 500, 700, 600, 450, 300)[i] * (1 - exp(-a / c(6, 4, 8, 6, 3, 2)[i])) + rnorm(n, 0, c(20, 5, 40, 30, 10, 1)[i])
  sequence(paste("noisy", i), a, pmax(v, 5))
}

velocities <- function(t, x, y, window) {
  n <- length(t)
  sapply(seq_len(n), function(i) {
    from <- which(t >= t[i] - window / 2 & seq_len(n) < i)
    to <- which(t <= t[i] + window / 2 & seq_len(n) > i)
    a <- if (length(from)) min(from) else max(1, i - 1)
    b <- if (length(to)) max(to) else min(n, i + 1)
    c(angle(x[a], y[a], x[b], y[b]) / ((t[b] - t[a]) / 1000), t[b] - t[a])
  })
}
# Of samples first to last: the fastest; NA where its velocity or a neighbour's is over more than 17.5 ms.
peak <- function(v, first, last) {
  at <- first - 1 + which.max(v[1, first:last])
  spans <- v[2, max(1, at - 1):min(ncol(v), at + 1)]
  if (max(spans) <= 17.5) v[1, at] else NA
}
ivt <- function(name, t, x, y, p) {
  v <- velocities(t, x, y, p[2])[1, ]; peaks <- velocities(t, x, y, p[7])
  runs <- rle(v > p[1])
  last <- cumsum(runs$lengths); first <- last - runs$lengths + 1
  # fixations as lists of samples, joined while two neighbours are close
  fix <- Map(c, first[!runs$values], last[!runs$values])
  sac <- Map(c, first[runs$values], last[runs$values])
  middle <- function(f) c(mean(x[f[1]:f[2]]), mean(y[f[1]:f[2]]))
  i <- 1
  while (i < length(fix)) {
    a <- middle(fix[[i]]); b <- middle(fix[[i + 1]])
    if (p[5] > 0 && t[fix[[i + 1]][1]] - t[fix[[i]][2]] <= p[5] && angle(a[1], a[2], b[1], b[2]) <= p[6]) {
      whole <- c(fix[[i]][1], fix[[i + 1]][2])
      sac <- Filter(function(s) !(s[1] > whole[1] && s[2] < whole[2]), sac)
      fix[[i]] <- whole
      fix[[i + 1]] <- NULL
    } else i <- i + 1
  }
  events <- rbind(
    do.call(rbind, lapply(Filter(function(f) t[f[2]] - t[f[1]] >= p[3], fix), function(f) c(1, f - 1, 0, 0))),
    do.call(rbind, lapply(Filter(function(s) t[s[2]] - t[s[1]] >= p[4], sac), function(s)
      c(2, s - 1, angle(x[s[1]], y[s[1]], x[s[2]], y[s[2]]), peak(peaks, s[1], s[2])))))
  if (!is.null(events)) events <- events[order(events[, 2]), , drop = FALSE]
  line("ivt", name, num(t), num(x), num(y), num(p), if (is.null(events)) "" else num(t(events)))
}
idt <- function(name, t, x, y, p) {
  n <- length(t); events <- NULL; first <- 1
  within <- function(a, b) diff(range(x[a:b])) + diff(range(y[a:b])) <= p[1]
  while (first <= n) {
    last <- first
    while (last < n && within(first, last + 1)) last <- last + 1
    if (t[last] - t[first] >= p[2] && last > first) {
      events <- c(events, 1, first - 1, last - 1, 0, 0)
      first <- last + 1
    } else first <- first + 1
  }
  line("idt", name, num(t), num(x), num(y), num(p), if (is.null(events)) "" else num(events))
}
walk <- function(n, hz, noise) {
  t <- cumsum(round(1e6 / hz * (1 + runif(n, -0.1, 0.1)))) / 1e6 * 1000 # whole nanoseconds
  x <- numeric(n); y <- numeric(n); at <- c(0, 0); i <- 1
  while (i <= n) {
    rest <- sample(round(hz * 0.05):round(hz * 0.4), 1)
    to <- at + rnorm(2, 0, 6); move <- max(2, round(hz * (0.021 + 0.0022 * sqrt(sum((to - at)^2)))))
    s <- c(rep(0, rest), (1 - cos(pi * seq_len(move) / move)) / 2)
    k <- i:min(n, i + length(s) - 1)
    x[k] <- at[1] + s[seq_along(k)] * (to[1] - at[1]); y[k] <- at[2] + s[seq_along(k)] * (to[2] - at[2])
    at <- to; i <- i + length(s)
  }
  list(t = t, x = x + rnorm(n, 0, noise), y = y + rnorm(n, 0, noise))
}
usual <- c(30, 20, 60, 10, 75, 0.5, 8)
for (i in 1:12) {
  hz <- c(60, 120, 250, 500)[(i - 1) %% 4 + 1]
  w <- walk(250, hz, c(0.01, 0.1, 0.4)[(i - 1) %/% 4 + 1])
  name <- sprintf("%g Hz noise %d", hz, (i - 1) %/% 4 + 1)
  ivt(name, w$t, w$x, w$y, usual)
  ivt(paste(name, "plain"), w$t, w$x, w$y, c(50, 0, 0, 0, 0, 0, 0))
  idt(name, w$t, w$x, w$y, c(1, 100))
  idt(paste(name, "tight"), w$t, w$x, w$y, c(0.3, 50))
}
still <- seq(0, 400, by = 4)
ivt("constant", still, still * 0 + 3, still * 0 - 2, usual)
idt("constant", still, still * 0 + 3, still * 0 - 2, c(1, 100))
ivt("two samples", c(0, 4), c(0, 0), c(0, 0), usual)
ivt("ramp above the threshold", still, still * 0.031, still * 0, usual)
ivt("ramp below the threshold", still, still * 0.029, still * 0, usual)

# A point on the horizontal circle of the eyes' axis: with the head turned by x it lies straight ahead and up by y, and the eye
# lies to the right by right cos(x) and ahead by right sin(x).
eye <- function(name, x, y, distance, right) {
  rx <- x * pi / 180; ry <- y * pi / 180
  ahead <- distance * cos(ry) - right * sin(rx); side <- -right * cos(rx); up <- distance * sin(ry)
  line("eye", name, num(c(x, y, distance, right)),
       num(c(x + atan2(side, ahead) * 180 / pi, atan(up / sqrt(ahead^2 + side^2)) * 180 / pi)))
}
eye("ahead one metre left", 0, 0, 1, -0.0315)
eye("ahead one metre right", 0, 0, 1, 0.0315)
eye("ahead half a metre", 0, 0, 0.5, -0.0315)
eye("far", 5, -3, 1e6, 0.0315)
eye("middle", 12, 7, 2, 0)
for (i in 1:12) eye(paste("random", i), runif(1, -50, 50), runif(1, -40, 40), runif(1, 0.3, 5), runif(1, -0.04, 0.04))

for (hz in c(250, 500)) for (loss in c(0.2, 0.5)) { # at random
  w <- walk(500, hz, 0.02)
  k <- which(runif(500) >= loss)
  ivt(sprintf("%g Hz loss %g", hz, loss), w$t[k], w$x[k], w$y[k], usual)
}
close(out)
