# Maxima of likelihoods with many local ones, for analysis/stats/psychometric_fit: run with Rscript (minutes), writes
# psychometric_multistart.csv beside itself. 1500 random functions within the bounds of the search, of which the simplex goes on
# from the best 14 that are apart, over all parameters at once. Data sets: staircases of 60 answers that once were fitted at a
# local maximum, and a sample of 480 simulated ones (staircases of uneven and even steps, constant levels and single answers with
# free asymptotes, each by four families), most of them chosen because an earlier search missed their maximum.
# Columns: name, family, log, falling, guess_low, guess_high, lapse_low, lapse_high, levels, k, n (by spaces), threshold (on the
# axis), log_likelihood, range (of levels, on the axis).
set.seed(611)
F <- list(logistic = function(z) plogis(4 * z), normal = function(z) pnorm(sqrt(2 * pi) * z),
          gumbel = function(z) -expm1(-log(2) * exp(2 * z / log(2))), weibull = function(z) -expm1(-log(2) * exp(2 * z / log(2))))
G <- list(logistic = function(z) plogis(-4 * z), normal = function(z) pnorm(-sqrt(2 * pi) * z),
          gumbel = function(z) exp(-log(2) * exp(2 * z / log(2))), weibull = function(z) exp(-log(2) * exp(2 * z / log(2))))
num <- function(x) paste(sprintf("%.17g", x), collapse = " ")
sets <- list()
add <- function(name, family, falling, guess, lapse, x, k, n)
  sets[[length(sets) + 1]] <<- list(name = name, family = family, falling = falling, guess = guess, lapse = lapse, x = x, k = k, n = n)
z_of <- function(family, s, x, thr) s * if (family == "weibull") log(x / thr) else x - thr
for (family in names(F)) {
  for (i in 1:40) { # staircases of uneven steps
    thr <- runif(1, .2, .9); s <- sample(c(1, 3, 8, 15), 1); level <- 1; x <- k <- numeric(0)
    for (t in 1:60) {
      p <- .5 + .47 * F$logistic(s * (level - thr)); x[t] <- level; k[t] <- as.numeric(runif(1) < p)
      level <- max(.01, min(1.5, level + if (k[t]) -.05 * sample(c(1, 1, .5), 1) else .13))
    }
    add(paste("uneven", i), family, 0, c(.5, .5), c(0, .06), x, k, rep(1, 60))
  }
  for (i in 1:25) { # 1-up/2-down
    thr <- runif(1, .2, .9); s <- sample(c(1, 3, 8, 15), 1); level <- 1; x <- k <- numeric(0); right <- 0
    for (t in 1:60) {
      p <- .5 + .48 * F[[family]](z_of(family, s, level, thr)); x[t] <- level; k[t] <- as.numeric(runif(1) < p)
      if (k[t]) {
        right <- right + 1
        if (right == 2) { right <- 0; level <- max(.05, level - .05) }
      } else { right <- 0; level <- min(1.5, level + .05) }
    }
    add(paste("even", i), family, 0, c(.5, .5), c(0, .06), round(x, 10), k, rep(1, 60))
  }
  for (i in 1:35) { # constant levels
    m <- sample(5:9, 1); x <- seq(.2, 2, length.out = m); n <- rep(sample(c(5, 10, 20), 1), m); thr <- runif(1, .4, 1.8)
    s <- sample(c(.5, 1, 3, 8), 1); falling <- i %% 2
    k <- rbinom(m, n, .1 + .82 * F[[family]](z_of(family, s, x, thr) * if (falling) -1 else 1))
    add(paste("constant", i), family, falling, c(0, .5), c(0, .5), x, k, n)
  }
  for (i in 1:20) { # single answers
    x <- sort(runif(60, .1, 2)); thr <- runif(1, .4, 1.8); s <- sample(c(1, 3, 10), 1)
    k <- rbinom(60, 1, .12 + .8 * F[[family]](z_of(family, s, x, thr)))
    add(paste("single", i), family, 0, c(0, .5), c(0, .5), x, k, rep(1, 60))
  }
}
missed <- c(5, 8, 26, 28, 47, 104, 107, 126, 131, 161, 186, 207, 223, 233, 244, 255, 266, 271, 315, 346, 349, 365, 373, 381, 402,
            429, 449, 473, 477, 480)
sets <- sets[sort(unique(c(missed, seq(1, 480, by = 20))))]
hard <- function(families, answers, x) for (family in families)
  add("local maximum", family, 0, c(.5, .5), c(0, .06), x, as.numeric(strsplit(answers, "")[[1]]), rep(1, 60))
hard(c("logistic", "normal"),
     "111111111111111111111000111111100111111100111110110011101101",
     c(1, 0.95, 0.9, 0.875, 0.825, 0.775, 0.725, 0.675, 0.625, 0.575, 0.55, 0.5, 0.475, 0.425, 0.375, 0.325, 0.275, 0.225,
     0.175, 0.125, 0.075, 0.025, 0.155, 0.285, 0.415, 0.365, 0.315, 0.29, 0.265, 0.215, 0.19, 0.14, 0.27, 0.4, 0.375, 0.35,
     0.3, 0.25, 0.225, 0.175, 0.125, 0.255, 0.385, 0.335, 0.285, 0.235, 0.185, 0.135, 0.265, 0.215, 0.165, 0.295, 0.425,
     0.375, 0.325, 0.275, 0.405, 0.355, 0.33, 0.46))
hard(c("logistic", "gumbel"),
     "111111111111111111110111110110111011111001111101110011111111",
     c(1, 0.95, 0.925, 0.875, 0.825, 0.775, 0.725, 0.7, 0.65, 0.625, 0.6, 0.55, 0.5, 0.475, 0.45, 0.4, 0.35, 0.3, 0.275,
     0.25, 0.2, 0.33, 0.28, 0.23, 0.205, 0.18, 0.13, 0.26, 0.21, 0.16, 0.29, 0.265, 0.24, 0.19, 0.32, 0.295, 0.27, 0.22,
     0.17, 0.12, 0.25, 0.38, 0.33, 0.28, 0.23, 0.18, 0.13, 0.26, 0.21, 0.16, 0.11, 0.24, 0.37, 0.32, 0.27, 0.245, 0.195,
     0.145, 0.095, 0.07))
hard(c("gumbel"),
     "111101011111111011011001111011111111011110011111010111010011",
     c(1, 0.95, 0.9, 0.85, 0.825, 0.955, 0.905, 1.035, 1.01, 0.985, 0.935, 0.885, 0.86, 0.81, 0.76, 0.71, 0.84, 0.79, 0.74,
     0.87, 0.82, 0.77, 0.9, 1.03, 0.98, 0.93, 0.905, 0.855, 0.985, 0.935, 0.885, 0.835, 0.81, 0.785, 0.735, 0.71, 0.66,
     0.79, 0.765, 0.715, 0.665, 0.615, 0.745, 0.875, 0.85, 0.8, 0.775, 0.725, 0.7, 0.83, 0.78, 0.91, 0.86, 0.81, 0.785,
     0.915, 0.865, 0.995, 1.125, 1.075))
hard(c("gumbel"),
     "111111110011111111111111111011111001111111000111111111010011",
     c(1, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65, 0.6, 0.73, 0.86, 0.835, 0.785, 0.76, 0.735, 0.71, 0.685, 0.635, 0.61, 0.585,
     0.56, 0.51, 0.46, 0.435, 0.385, 0.36, 0.31, 0.26, 0.39, 0.34, 0.315, 0.29, 0.24, 0.19, 0.32, 0.45, 0.4, 0.35, 0.325,
     0.3, 0.275, 0.225, 0.175, 0.305, 0.435, 0.565, 0.54, 0.49, 0.44, 0.39, 0.365, 0.315, 0.29, 0.24, 0.19, 0.32, 0.27,
     0.4, 0.53, 0.48))
hard(c("weibull"),
     "111101111011111001111111111111100011111111111011010111101011",
     c(1, 0.95, 0.925, 0.875, 0.85, 0.98, 0.93, 0.88, 0.83, 0.78, 0.91, 0.885, 0.835, 0.785, 0.76, 0.71, 0.84, 0.97, 0.945,
     0.92, 0.87, 0.82, 0.77, 0.72, 0.67, 0.62, 0.57, 0.545, 0.495, 0.445, 0.395, 0.345, 0.475, 0.605, 0.735, 0.71, 0.66,
     0.635, 0.585, 0.56, 0.535, 0.485, 0.46, 0.41, 0.36, 0.31, 0.44, 0.39, 0.34, 0.47, 0.42, 0.55, 0.5, 0.45, 0.425, 0.4,
     0.53, 0.48, 0.61, 0.56))

fit <- function(d) {
  u <- if (d$family == "weibull") log(d$x) else d$x
  o <- order(u); u <- u[o]; R <- diff(range(u))
  g <- cumsum(c(1, diff(u) > 1e-9 * R)) # levels that differ by rounding are one
  k <- as.vector(rowsum(d$k[o], g)); n <- as.vector(rowsum(d$n[o], g)); u <- u[!duplicated(g)]; gap <- min(diff(u))
  low <- c(min(u) - R, log(.1 / R), d$guess[1], d$lapse[1]); high <- c(max(u) + R, log(10 / gap), d$guess[2], d$lapse[2])
  free <- which(high > low)
  value <- function(v) {
    if (any(v < 0 | v > 1)) return(1e10)
    q <- low; q[free] <- low[free] + v * (high - low)[free]
    z <- (if (d$falling) -1 else 1) * exp(q[2]) * (u - q[1]); f <- F[[d$family]](z); s <- G[[d$family]](z)
    yes <- q[3] * s + (1 - q[4]) * f; no <- q[4] * f + (1 - q[3]) * s
    -sum(ifelse(k > 0, k * log(pmax(yes, 1e-300)), 0) + ifelse(n > k, (n - k) * log(pmax(no, 1e-300)), 0))
  }
  P <- matrix(runif(1500 * length(free)), 1500)
  P[, 1] <- ifelse(runif(1500) < .7, (1 + runif(1500)) / 3, P[, 1]) # among the levels more often
  o <- order(apply(P, 1, value))
  S <- P[o[1], , drop = FALSE]
  for (i in o[-1]) {
    if (nrow(S) >= 14) break
    if (min(abs(S[, 1] - P[i, 1]) * 30 + abs(S[, 2] - P[i, 2]) * 8) > 1) S <- rbind(S, P[i, ])
  }
  best <- list(value = Inf)
  for (i in seq_len(nrow(S))) {
    r <- optim(S[i, ], value, control = list(maxit = 500, reltol = 1e-8))
    r <- optim(r$par, value, control = list(maxit = 500, reltol = 1e-10))
    if (r$value < best$value) best <- r
  }
  for (i in 1:4) { # the simplex again and again, from where it stopped
    r <- optim(best$par, value, control = list(maxit = 2000, reltol = 1e-15))
    if (r$value <= best$value) best <- r
  }
  paste(c(d$name, d$family, 0, d$falling, num(d$guess[1]), num(d$guess[2]), num(d$lapse[1]), num(d$lapse[2]), num(d$x), num(d$k),
          num(d$n), num(low[1] + best$par[1] * (high - low)[1]), num(-best$value), num(R)), collapse = ",")
}
rows <- sapply(sets, fit)
writeLines(c("name,family,log,falling,guess_low,guess_high,lapse_low,lapse_high,levels,k,n,threshold,log_likelihood,range", rows),
           "psychometric_multistart.csv")
