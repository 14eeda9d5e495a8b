# Reference values for analysis/stats/psychometric_bayes where a grid in R would be too large: many answers, both asymptotes
# free. Run with Rscript (minutes), writes psychometric_bayes_sampled.csv beside itself. Independent draws, weighted by the
# posterior of psychometric_bayes.h over the density they were drawn from (importance sampling; a mixture of Student's t with 5
# degrees of freedom, centres and covariances from six rounds of the same). Coordinates: threshold, ln width, and cube roots
# of lapse, eta and guess over their ends, near 0 of which many posteriors crowd.
# Columns: name, family, log, falling, guess (NA: free), lapse_end (0: fixed at 0), levels, k, n (by spaces), then mean, sd,
# median, low, high of threshold, width, lapse, eta and guess (NA: fixed), then error: the largest standard error of all these
# numbers, from 40 batches, as a share of the interval's width (of the SD for an SD).
set.seed(2016)
F <- list(logistic = plogis, normal = pnorm, gumbel = function(z) -expm1(-exp(z)), weibull = function(z) -expm1(-exp(z)))
S <- list(logistic = function(z) plogis(-z), normal = function(z) pnorm(-z), gumbel = function(z) exp(-exp(z)),
          weibull = function(z) exp(-exp(z)))
Q <- list(logistic = qlogis, normal = qnorm, gumbel = function(p) log(-log(1 - p)), weibull = function(p) log(-log(1 - p)))
rows <- list()
DRAWS <- 1600000; BATCHES <- 40

# ln posterior of many points at once, one a row of q
posterior <- function(q, d) {
  R <- diff(range(d$u)); gap <- min(diff(sort(unique(d$u))))
  at <- q[, 1]; width <- exp(q[, 2])
  t <- q[, -(1:2), drop = FALSE]
  inside <- rowSums(t <= 0 | t >= 1) == 0
  t <- pmin(pmax(t, 1e-9), 1 - 1e-9)
  column <- 2
  cube <- function(end, power) { # density of t where end * t^3 is Beta(1, power + 1)
    column <<- column + 1
    x <- end * t[, column - 2]^3
    list(x = x, ln = 2 * log(t[, column - 2]) + power * log1p(-x))
  }
  lapse <- if (d$lapse > 0) cube(d$lapse, 9) else list(x = 0, ln = 0)
  eta <- cube(1, 9)
  guess <- if (is.na(d$guess)) cube(0.5, 9) else list(x = d$guess, ln = 0)
  b <- pmax(min(d$u) - at, at - max(d$u)) / R
  prior <- ifelse(b <= 0, 1, ifelse(b >= 0.5, 0, 0.5 + 0.5 * cos(2 * pi * b))) *
    ifelse(width <= gap, 0, ifelse(width >= 2 * gap, 1, 0.5 - 0.5 * cos(pi * (width - gap) / gap))) *
    ifelse(width <= R, 1, ifelse(width >= 3 * R, 0, 0.5 + 0.5 * cos(pi / 2 * (width - R) / R)))
  ln <- log(prior) + q[, 2] + lapse$ln + eta$ln + guess$ln
  nu <- pmin(1 / eta$x^2 - 1, 1e8) # beyond, lbeta loses its digits and the answers are binomial
  span <- Q[[d$family]](0.95) - Q[[d$family]](0.05)
  for (i in seq_along(d$u)) {
    z <- Q[[d$family]](0.5) + (if (d$falling) -1 else 1) * span / width * (d$u[i] - at)
    f <- F[[d$family]](z); s <- S[[d$family]](z)
    yes <- pmax(guess$x * s + (1 - lapse$x) * f, 1e-300); no <- pmax((1 - guess$x) * s + lapse$x * f, 1e-300)
    ln <- ln + lbeta(d$k[i] + nu * yes, d$n[i] - d$k[i] + nu * no) - lbeta(nu * yes, nu * no)
  }
  ifelse(inside & prior > 0, ln, -Inf)
}

# A mixture of Student's t with 5 degrees of freedom; each part: share, centre, L (upper, L'L the covariance).
draw <- function(n, parts, df = 5) {
  size <- length(parts[[1]]$centre)
  which <- sample(length(parts), n, TRUE, sapply(parts, function(p) p$share))
  z <- matrix(rnorm(n * size), n) / sqrt(rchisq(n, df) / df)
  q <- matrix(0, n, size)
  for (i in seq_along(parts)) q[which == i, ] <- t(t(z[which == i, ] %*% parts[[i]]$L) + parts[[i]]$centre)
  density <- 0
  for (p in parts) {
    z <- t(backsolve(p$L, t(q) - p$centre, transpose = TRUE))
    density <- density + p$share / prod(diag(p$L)) * (1 + rowSums(z^2) / df)^(-(df + size) / 2)
  }
  list(q = q, ln = log(density))
}

part <- function(q, w, share, wider) {
  centre <- colSums(w * q) / sum(w)
  off <- sweep(q, 2, centre)
  list(share = share, centre = centre, L = chol(wider * crossprod(off * sqrt(w)) / sum(w) + diag(1e-12, ncol(q))))
}

weighted <- function(x, w) {
  o <- order(x); p <- cumsum(w[o]) / sum(w)
  m <- sum(w * x) / sum(w)
  c(m, sqrt(sum(w * (x - m)^2) / sum(w)), x[o][sapply(c(0.5, 0.025, 0.975), function(s) which(p >= s)[1])])
}

bayes <- function(name, family, x, k, n, guess = NA, lapse = 0.5, log = FALSE, falling = FALSE) {
  d <- list(u = if (log || family == "weibull") base::log(x) else x, k = k, n = n, guess = guess, lapse = lapse,
            family = family, falling = falling)
  R <- diff(range(d$u)); gap <- min(diff(sort(unique(d$u))))
  size <- 3 + (lapse > 0) + is.na(guess)
  one <- function(v) { l <- posterior(matrix(v, 1), d); if (is.finite(l)) -l else 1e10 }
  best <- list(value = Inf)
  for (at in quantile(d$u, c(0.2, 0.4, 0.6, 0.8))) for (w in base::log(c(1.5 * gap, 3 * gap, R / 2, R))) {
    r <- optim(c(at, w, rep(0.4, size - 2)), one, control = list(maxit = 3000, reltol = 1e-10))
    if (r$value < best$value) best <- r
  }
  parts <- list(list(share = 1, centre = best$par, L = diag(c(R / 30, 0.3, rep(0.1, size - 2)))))
  for (round in 1:6) {
    y <- draw(60000, parts)
    ln <- posterior(y$q, d) - y$ln
    w <- exp(ln - max(ln)); w <- pmin(w, sort(w, decreasing = TRUE)[300]) # a first guess may be far too narrow
    parts <- list(part(y$q, w, 1, 1.15))
    if (round > 2) { # and its tails, where it bends
      ends <- weighted(y$q[, 1], w)[4:5]
      low <- y$q[, 1] < ends[1] + 0.1 * (ends[2] - ends[1]); high <- y$q[, 1] > ends[2] - 0.1 * (ends[2] - ends[1])
      parts <- list(part(y$q, w, 0.6, 1.15), part(y$q[low, ], w[low], 0.2, 1.5), part(y$q[high, ], w[high], 0.2, 1.5))
    }
  }
  y <- draw(DRAWS, parts)
  ln <- posterior(y$q, d) - y$ln
  w <- exp(ln - max(ln))
  back <- if (log || family == "weibull") exp else identity
  parts <- list(back(y$q[, 1]), exp(y$q[, 2]))
  column <- 2
  nextcube <- function(end) { column <<- column + 1; end * y$q[, column]^3 }
  parts[[3]] <- if (lapse > 0) nextcube(lapse) else NA
  parts[[4]] <- nextcube(1)
  parts[[5]] <- if (is.na(guess)) nextcube(0.5) else NA
  batch <- rep(seq_len(BATCHES), length.out = DRAWS)
  worst <- 0
  values <- sapply(parts, function(v) {
    if (length(v) == 1) return(rep(NA, 5))
    all <- weighted(v, w)
    each <- sapply(seq_len(BATCHES), function(b) weighted(v[batch == b], w[batch == b]))
    error <- apply(each, 1, sd) / sqrt(BATCHES) / c(all[5] - all[4], all[2], rep(all[5] - all[4], 3))
    worst <<- max(worst, error)
    all
  })
  num <- function(x) paste(sprintf("%.10g", x), collapse = " ")
  cat(name, "effective draws", sum(w)^2 / sum(w^2), "error", worst, "\n")
  rows[[length(rows) + 1]] <<- paste(c(gsub(",", ";", name), family, as.integer(log), as.integer(falling), guess, lapse, num(x), num(k), num(n),
                                       sapply(values, num), num(worst)), collapse = ",")
}

h <- rep(100, 9); twice <- rep(200, 9)
bayes("lapses and guesses, 9 x 100", "logistic", 0:8, c(10, 12, 13, 26, 57, 74, 91, 97, 99), h)
bayes("lapses and guesses, 9 x 200", "logistic", 0:8, c(22, 13, 31, 65, 102, 167, 189, 196, 191), twice)
bayes("many guesses, 9 x 200", "logistic", 0:8, c(60, 68, 70, 85, 131, 167, 189, 200, 196), twice)
bayes("no lapses, 11 x 40", "logistic", 0:10, c(0, 2, 8, 22, 39, 40, 40, 40, 40, 40, 40), rep(40, 11))
bayes("few lapses, 11 x 100", "logistic", 0:10, c(7, 12, 15, 16, 31, 65, 91, 99, 100, 100, 98), rep(100, 11))
bayes("steep, 7 x 60", "logistic", 0:6, c(0, 2, 3, 43, 60, 60, 60), rep(60, 7))
bayes("many levels, guess fixed", "logistic", seq(0, 1, by = 0.02),
      c(18, 15, 17, 24, 22, 16, 26, 17, 18, 23, 22, 15, 22, 15, 24, 29, 21, 22, 19, 19, 23, 19, 19, 22, 22, 19, 21, 38, rep(40, 23)),
      rep(40, 51), guess = 0.5)
bayes("overdispersed, free", "normal", 1:8, c(12, 4, 19, 16, 35, 24, 39, 31), rep(40, 8))
bayes("falling weibull, free", "weibull", c(0.1, 0.2, 0.4, 0.8, 1.6, 3.2), c(57, 58, 50, 30, 9, 8), rep(60, 6), falling = TRUE)
bayes("gumbel, 500 a level", "gumbel", 1:6, c(41, 60, 143, 301, 441, 472), rep(500, 6))
bayes("single answers, free", "logistic", seq(0.1, 2, by = 0.1), c(0, 0, 1, 0, 0, 1, 0, 1, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 1), rep(1, 20))
bayes("lapse fixed, guess free", "normal", 1:7, c(14, 11, 16, 33, 47, 49, 50), rep(50, 7), lapse = 0)
writeLines(c(paste("name,family,log,falling,guess,lapse_end,levels,k,n",
                   paste(outer(c("mean", "sd", "median", "low", "high"), c("threshold", "width", "lapse", "eta", "guess"),
                               function(a, b) paste0(b, "_", a)), collapse = ","), "error", sep = ","), unlist(rows)),
           "psychometric_bayes_sampled.csv")
