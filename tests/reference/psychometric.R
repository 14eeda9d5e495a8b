# Reference values for analysis/stats/psychometric_fit: run with Rscript, writes psychometric.csv beside itself.
# Columns: name, family, log, falling, guess_low, guess_high, lapse_low, lapse_high, levels, k, n (by spaces), status,
# threshold, slope, guess, lapse, log_likelihood, deviance, low, high (profile interval, 95 %).
# Everything by optim over all parameters at once (50 starts, L-BFGS-B, then Nelder and Mead), where our code solves the
# asymptotes apart. Distributions are R's own plogis, pnorm and a complementary log-log.
# status: ok, step, no_effect, one_level, all_no, all_yes, open
set.seed(20161)
F <- list(logistic = function(z) plogis(4 * z), normal = function(z) pnorm(sqrt(2 * pi) * z),
          gumbel = function(z) -expm1(-log(2) * exp(2 * z / log(2))),
          weibull = function(z) -expm1(-log(2) * exp(2 * z / log(2))))
G <- list(logistic = function(z) plogis(-4 * z), normal = function(z) pnorm(-sqrt(2 * pi) * z),
          gumbel = function(z) exp(-log(2) * exp(2 * z / log(2))),
          weibull = function(z) exp(-log(2) * exp(2 * z / log(2))))
xlogp <- function(k, p) ifelse(k > 0, k * log(pmax(p, 1e-300)), 0)

problem <- function(d) {
  keep <- d$n > 0
  u <- if (d$log || d$family == "weibull") log(d$x[keep]) else d$x[keep]
  k <- tapply(d$k[keep], u, sum); n <- tapply(d$n[keep], u, sum); u <- sort(unique(u))
  range <- diff(range(u)); gap <- if (length(u) > 1) min(diff(u)) else NA
  sign <- if (d$falling) -1 else 1
  f <- F[[d$family]]; g <- G[[d$family]]
  ll <- function(p) { # at, ln slope, guess, lapse
    z <- sign * exp(p[2]) * (u - p[1])
    yes <- p[3] * g(z) + (1 - p[4]) * f(z); no <- p[4] * f(z) + (1 - p[3]) * g(z)
    sum(xlogp(k, yes) + xlogp(n - k, no))
  }
  low <- c(min(u) - range, log(0.1 / range), d$guess[1], d$lapse[1])
  high <- c(max(u) + range, log(10 / gap), d$guess[2], d$lapse[2])
  list(u = u, k = k, n = n, ll = ll, low = low, high = high, sign = sign, range = range)
}

maximum <- function(p, starts, held = NULL) { # held: c(index, value)
  free <- which(p$high > p$low)
  if (!is.null(held)) free <- setdiff(free, held[1])
  base <- p$low
  if (!is.null(held)) base[held[1]] <- held[2]
  full <- function(v) { q <- base; q[free] <- v; q }
  inside <- function(v) all(v >= p$low[free] & v <= p$high[free])
  value <- function(v) if (inside(v)) -p$ll(full(v)) else 1e10
  best <- NULL
  for (s in 1:starts) {
    start <- p$low[free] + runif(length(free)) * (p$high - p$low)[free]
    r <- try(optim(start, value, method = "L-BFGS-B", lower = p$low[free], upper = p$high[free]), silent = TRUE)
    if (inherits(r, "try-error")) r <- list(par = start, value = value(start))
    if (is.null(best) || r$value < best$value) best <- r
  }
  if (length(free) > 1)
    for (i in 1:6) { # the simplex again and again, from where it stopped
      r <- optim(best$par, value, method = "Nelder-Mead", control = list(reltol = 1e-15, maxit = 5000))
      if (r$value <= best$value) best <- r
    }
  else {
    r <- optimize(value, c(max(p$low[free], best$par - 1), min(p$high[free], best$par + 1)), tol = 1e-10)
    if (r$objective < best$value) best <- list(par = r$minimum, value = r$objective)
  }
  list(par = full(best$par), ll = -best$value)
}

step_limit <- function(p, d) {
  best <- -Inf
  m <- length(p$u)
  for (i in 1:m) for (own in c(TRUE, FALSE)) {
    f <- as.numeric(if (d$falling) seq_len(m) < i else seq_len(m) >= i)
    low <- c(d$guess[1], d$lapse[1], 0); high <- c(d$guess[2], d$lapse[2], 1)
    open <- which(high > low)
    value <- function(free) {
      v <- low; v[open] <- free # guess, lapse, share at the step
      yes <- ifelse(f == 1, 1 - v[2], v[1])
      if (own) yes[i] <- v[1] + (1 - v[1] - v[2]) * v[3]
      -sum(xlogp(p$k, yes) + xlogp(p$n - p$k, 1 - yes))
    }
    for (start in list(c(0.5, 0.5, 0.5), c(0.1, 0.1, 0.9), c(0.1, 0.1, 0.1))) {
      r <- optim((low + start * (high - low))[open], value, method = "L-BFGS-B", lower = low[open], upper = high[open],
                 control = list(factr = 10))
      best <- max(best, -r$value)
    }
  }
  best
}

interval <- function(p, best, limit) {
  prof <- function(at) maximum(p, 8, c(1, at))$ll - limit
  end <- function(from, to) {
    xs <- from + (to - from) * (0:31) / 32
    for (i in seq_along(xs)) if (prof(xs[i]) >= 0) {
      if (i == 1) return(NA)
      return(uniroot(prof, sort(c(xs[i - 1], xs[i])), tol = 1e-7 * p$range)$root)
    }
    uniroot(prof, sort(c(xs[32], to)), tol = 1e-7 * p$range)$root
  }
  c(end(p$low[1], best$par[1]), end(p$high[1], best$par[1]))
}

rows <- list()
num <- function(x) paste(sprintf("%.17g", x), collapse = " ")
fit <- function(name, family, x, k, n, guess, lapse, log = FALSE, falling = FALSE) {
  d <- list(family = family, x = x, k = k, n = n, guess = guess, lapse = lapse, log = log, falling = falling)
  p <- problem(d)
  out <- rep(NA, 6); ends <- c(NA, NA)
  status <- if (length(p$u) < 2) "one_level" else if (sum(p$k) == 0) "all_no" else if (sum(p$k) == sum(p$n)) "all_yes" else "ok"
  if (status == "ok") {
    best <- maximum(p, 50)
    share <- min(max(sum(p$k) / sum(p$n), guess[1]), 1 - lapse[1])
    constant <- sum(xlogp(p$k, share) + xlogp(p$n - p$k, 1 - share))
    saturated <- sum(xlogp(p$k, p$k / p$n) + xlogp(p$n - p$k, 1 - p$k / p$n))
    if (constant >= best$ll - 1e-6) status <- "no_effect"
    else if (step_limit(p, d) >= best$ll - 1e-6) status <- "step"
    else {
      ends <- interval(p, best, best$ll - qchisq(0.95, 1) / 2)
      if (any(is.na(ends))) status <- "open"
      back <- if (log || family == "weibull") exp else identity
      ends <- back(ends)
      out <- c(back(best$par[1]), exp(best$par[2]), best$par[3], best$par[4], best$ll, 2 * (saturated - best$ll))
    }
  }
  rows[[length(rows) + 1]] <<- paste(c(gsub(",", ";", name), family, as.integer(log), as.integer(falling), num(guess[1]), num(guess[2]),
    num(lapse[1]), num(lapse[2]), num(x), num(k), num(n), status, sapply(out, num), sapply(ends, num)), collapse = ",")
}

afc <- c(0.5, 0.5); none <- c(0, 0); wh <- c(0, 0.06); free <- c(0, 0.5)
# By hand: the edges.
fit("none of n", "logistic", 1:5, rep(0, 5), rep(10, 5), none, none)
fit("n of n", "logistic", 1:5, rep(10, 5), rep(10, 5), afc, wh)
fit("one level", "normal", c(2, 2, 2), c(3, 4, 5), c(10, 10, 10), none, none)
fit("one level left", "normal", c(1, 2, 3), c(0, 4, 0), c(0, 10, 0), none, none)
fit("separation", "logistic", 1:6, c(0, 0, 0, 10, 10, 10), rep(10, 6), none, none)
fit("separation but one level", "logistic", 1:5, c(0, 0, 5, 10, 10), rep(10, 5), none, none)
fit("separation, 2AFC", "weibull", 1:6, c(5, 5, 5, 10, 10, 10), rep(10, 6), afc, none)
fit("separation, falling", "gumbel", 1:6, c(10, 10, 10, 0, 0, 0), rep(10, 6), none, none, falling = TRUE)
fit("wrong way", "logistic", 1:5, c(9, 8, 5, 2, 1), rep(10, 5), none, none)
fit("no effect", "normal", 1:5, c(5, 5, 5, 5, 5), rep(10, 5), none, none)
fit("chance, 2AFC", "logistic", 1:5, c(5, 4, 5, 6, 5), rep(10, 5), afc, wh)
fit("barely rises", "logistic", 1:5, c(4, 5, 5, 5, 6), rep(10, 5), none, none)
fit("lapses at the top", "logistic", 1:7, c(10, 11, 14, 17, 19, 18, 19), rep(20, 7), afc, wh)
fit("many lapses", "normal", 1:7, c(1, 0, 6, 14, 16, 15, 17), rep(20, 7), none, c(0, 0.4))
fit("few answers", "logistic", 1:4, c(0, 1, 1, 2), c(1, 2, 2, 2), none, none)
fit("unequal n", "weibull", c(0.1, 0.2, 0.4, 0.8), c(6, 20, 31, 9), c(10, 30, 35, 9), afc, wh)
fit("levels repeated", "logistic", c(1, 2, 3, 1, 2, 3, 4), c(1, 3, 6, 2, 5, 8, 9), rep(10, 7), none, none)
fit("a level of no answers", "logistic", 1:5, c(1, 3, 0, 8, 9), c(10, 10, 0, 10, 10), none, none)
fit("large n", "normal", 1:6, c(21, 102, 310, 690, 905, 977), rep(1000, 6), none, wh)
fit("far from 0", "logistic", 1e6 + 1:6, c(1, 2, 4, 7, 9, 10), rep(10, 6), none, none)
fit("tiny levels", "weibull", 1e-6 * c(1, 2, 4, 8, 16), c(11, 12, 15, 19, 20), rep(20, 5), afc, wh)
fit("preference", "logistic", 1:7, c(4, 5, 8, 12, 15, 16, 15), rep(20, 7), free, free)
fit("preference, one sided", "normal", 1:6, c(2, 3, 5, 8, 9, 9), rep(20, 6), free, free)
fit("preference, falling", "gumbel", c(0.05, 0.1, 0.2, 0.4, 0.8), c(18, 17, 12, 6, 5), rep(20, 5), free, free, falling = TRUE)
fit("free lapse only", "gumbel", 1:6, c(1, 1, 5, 12, 16, 16), rep(20, 6), none, free)
fit("free guess only", "logistic", 1:6, c(4, 5, 7, 14, 19, 20), rep(20, 6), free, none)
fit("log axis", "logistic", c(0.02, 0.05, 0.1, 0.2, 0.5), c(10, 12, 15, 19, 20), rep(20, 5), afc, wh, log = TRUE)
fit("log axis, falling", "normal", c(0.02, 0.05, 0.1, 0.2, 0.5), c(20, 19, 15, 12, 10), rep(20, 5), afc, wh, log = TRUE, falling = TRUE)
# Drawn: constant stimuli and staircases, every family, both ways.
draw <- function(family, x, n, at, slope, guess, lapse, sign, log) {
  u <- if (log || family == "weibull") log(x) - log(at) else x - at
  rbinom(length(x), n, guess + (1 - guess - lapse) * F[[family]](sign * slope * u))
}
staircase <- function(family, at, slope, guess, lapse, steps, trials) {
  level <- max(steps); x <- k <- numeric(0); right <- 0
  for (i in 1:trials) {
    k[i] <- draw(family, level, 1, at, slope, guess, lapse, 1, FALSE); x[i] <- level
    right <- if (k[i]) right + 1 else 0
    if (!k[i]) level <- min(max(steps), level + steps[2] - steps[1])
    else if (right == 2) { level <- max(min(steps), level - (steps[2] - steps[1])); right <- 0 }
  }
  list(x = round(x, 10), k = k, n = rep(1, trials))
}
for (family in names(F)) for (i in 1:4) {
  sign <- if (i %% 2) 1 else -1
  x <- seq(0.1, 1, length.out = 7)
  n <- rep(c(10, 20, 40, 80)[i], 7)
  lapse <- if (i > 2) 0.04 else 0
  guess <- if (i == 4) 0 else 0.5
  k <- draw(family, x, n, 0.5, 2, guess, lapse, sign, FALSE)
  fit(paste("drawn", i), family, x, k, n, rep(guess, 2), if (i > 2) wh else none, falling = sign < 0)
}
for (family in names(F)) for (i in 1:3) {
  s <- staircase(family, 0.45, 2.5, 0.5, 0.02, seq(0.1, 1, by = 0.1), c(30, 60, 120)[i])
  fit(paste("staircase", i), family, s$x, s$k, s$n, afc, wh)
}
writeLines(c(paste("name,family,log,falling,guess_low,guess_high,lapse_low,lapse_high,levels,k,n,status,threshold,slope,guess",
                   "lapse,log_likelihood,deviance,low,high", sep = ","), unlist(rows)), "psychometric.csv")
