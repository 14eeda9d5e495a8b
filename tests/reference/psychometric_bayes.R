# Reference values for analysis/stats/psychometric_bayes: run with Rscript (minutes), writes psychometric_bayes.csv
# beside itself. The posterior by brute force on even grids of midpoints, four times finer than ours in threshold and
# width where the posterior has mass (a coarse pass over the priors' whole range tells where). Lapse, guess and eta, which
# ours integrates by other nodes, are end * t^3 on an even grid of t, so that many points lie near 0, where they may crowd.
# The beta-binomial is a product over the answers, checked against lbeta.
# Columns: name, family, log, falling, guess (NA: free), free_lapse, levels, k, n (by spaces), then mean, sd, median, low,
# high of threshold, width, lapse and eta.
F <- list(logistic = plogis, normal = pnorm, gumbel = function(z) -expm1(-exp(z)), weibull = function(z) -expm1(-exp(z)))
Q <- list(logistic = qlogis, normal = qnorm, gumbel = function(p) log(-log(1 - p)), weibull = function(p) log(-log(1 - p)))
rows <- list()
mid <- function(low, high, n) low + (high - low) * (seq_len(n) - 0.5) / n
cubed <- function(end, n) list(x = end * mid(0, 1, n)^3, w = 3 * end * mid(0, 1, n)^2 / n, edges = end * (0:n / n)^3)
even <- function(low, high, n) list(x = mid(low, high, n), w = rep((high - low) / n, n), edges = low + (high - low) * 0:n / n)
one <- function(x) list(x = x, w = 1, edges = c(x, x))
marginal <- function(g, mass, back = identity) {
  w <- mass / sum(mass)
  mean <- sum(w * back(g$x))
  # between the points the density is a spline; its sum over many is the cumulative share
  fine <- seq(min(g$edges), max(g$edges), length.out = 200001)
  density <- pmax(splinefun(g$x, w / g$w, method = "natural")(fine), 0)
  total <- c(0, cumsum(density[-1] + density[-length(density)]))
  q <- sapply(c(0.5, 0.025, 0.975), function(p) approx(total / max(total), fine, p, ties = "ordered")$y)
  c(mean, sqrt(sum(w * (back(g$x) - mean)^2)), back(q))
}
# ln of the beta-binomial without its coefficient; p a vector
rising <- function(p, nu, k, n) {
  r <- 1
  for (j in seq_len(k) - 1) r <- r * (p + j / nu)
  for (j in seq_len(n - k) - 1) r <- r * (1 - p + j / nu)
  for (j in seq_len(n) - 1) r <- r / (1 + j / nu)
  r
}
check <- c(0.1, 0.5, 0.93)
stopifnot(all.equal(log(rising(check, 3.7, 4, 9)), lbeta(4 + 3.7 * check, 5 + 3.7 * (1 - check)) - lbeta(3.7 * check, 3.7 * (1 - check)),
                    tolerance = 1e-12))
bayes <- function(name, family, x, k, n, guess, free_lapse = TRUE, log = FALSE, falling = FALSE, points = 164, deep = c(24, 40)) {
  u <- if (log || family == "weibull") base::log(x) else x
  R <- diff(range(u)); d <- min(diff(sort(unique(u))))
  # first a coarse pass for where the mass is, then the fine one over it
  pass <- function(ats, widths, lapses, etas, guesses) {
    beyond <- pmax(min(u) - ats, ats - max(u)) / R
    pa <- ifelse(beyond <= 0, 1, ifelse(beyond >= 0.5, 0, 0.5 + 0.5 * cos(2 * pi * beyond)))
    pw <- ifelse(widths <= d, 0, ifelse(widths >= 2 * d, 1, 0.5 - 0.5 * cos(pi * (widths - d) / d))) *
      ifelse(widths <= R, 1, ifelse(widths >= 3 * R, 0, 0.5 + 0.5 * cos(pi / 2 * (widths - R) / R)))
    at <- rep(ats, length(widths)); width <- rep(widths, each = length(ats))
    prior <- rep(pa, length(widths)) * rep(pw, each = length(ats))
    span <- Q[[family]](0.95) - Q[[family]](0.05)
    sign <- if (falling) -1 else 1
    shares <- lapply(u, function(v) F[[family]](Q[[family]](0.5) + sign * span / width * (v - at)))
    sum_all <- numeric(length(at)); by_lapse <- numeric(length(lapses$x)); by_eta <- numeric(length(etas$x))
    for (g in seq_along(guesses$x)) for (i in seq_along(lapses$x)) {
      yes <- lapply(shares, function(f) guesses$x[g] + (1 - guesses$x[g] - lapses$x[i]) * f)
      for (j in seq_along(etas$x)) {
        nu <- 1 / etas$x[j]^2 - 1
        w <- prior
        for (l in seq_along(u)) w <- w * rising(yes[[l]], nu, k[l], n[l]) * 1e3^(n[l] > 1) # far from underflow
        w <- w * dbeta(etas$x[j], 1, 10) * etas$w[j] * (if (free_lapse) dbeta(lapses$x[i], 1, 10) * lapses$w[i] else 1) *
          (if (length(guesses$x) > 1) dbeta(guesses$x[g], 1, 10) * guesses$w[g] else 1)
        sum_all <- sum_all + w; by_lapse[i] <- by_lapse[i] + sum(w); by_eta[j] <- by_eta[j] + sum(w)
      }
    }
    m <- matrix(sum_all, length(ats))
    list(at = rowSums(m), width = colSums(m), lapse = by_lapse, eta = by_eta)
  }
  guesses <- if (is.na(guess)) cubed(0.5, 8) else one(guess)
  lapses <- if (free_lapse) cubed(0.5, 8) else one(0)
  ats <- even(min(u) - R / 2, max(u) + R / 2, 60); widths <- even(d, 3 * R, 60)
  first <- pass(ats$x, widths$x, lapses, cubed(1, 10), guesses)
  part <- function(x, w) { r <- range(which(w > 1e-7 * max(w))); h <- x[2] - x[1]; c(x[r[1]] - h, x[r[2]] + h) }
  a <- part(ats$x, first$at); b <- pmax(part(widths$x, first$width), d)
  ats <- even(a[1], a[2], points); widths <- even(b[1], b[2], points)
  lapses <- if (free_lapse) cubed(0.5, deep[1]) else one(0)
  guesses <- if (is.na(guess)) cubed(0.5, 16) else one(guess)
  etas <- cubed(1, deep[2])
  r <- pass(ats$x, widths$x, lapses, etas, guesses)
  back <- if (log || family == "weibull") exp else identity
  num <- function(x) paste(sprintf("%.10g", x), collapse = " ")
  values <- c(marginal(ats, r$at, back), marginal(widths, r$width), if (free_lapse) marginal(lapses, r$lapse) else rep(NA, 5),
              marginal(etas, r$eta))
  rows[[length(rows) + 1]] <<- paste(c(name, family, as.integer(log), as.integer(falling), guess, as.integer(free_lapse),
    num(x), num(k), num(n), sapply(values, num)), collapse = ",")
}
bayes("yes or no", "logistic", 1:7, c(0, 1, 3, 6, 8, 10, 10), rep(10, 7), 0)
bayes("2AFC", "normal", 1:6, c(9, 11, 13, 17, 20, 19), rep(20, 6), 0.5)
bayes("overdispersed", "logistic", 1:6, c(3, 0, 14, 6, 19, 13), rep(20, 6), 0)
bayes("weibull", "weibull", c(0.1, 0.2, 0.4, 0.8, 1.6), c(6, 9, 14, 19, 20), rep(20, 5), 0.5)
bayes("falling", "gumbel", c(0.1, 0.3, 0.5, 0.7, 0.9), c(29, 28, 24, 17, 15), rep(30, 5), 0.5, falling = TRUE)
bayes("all right", "logistic", 1:5, rep(8, 5), rep(8, 5), 0.5)
bayes("no lapse", "logistic", c(0.05, 0.1, 0.2, 0.4), c(3, 8, 15, 19), rep(20, 4), 0, free_lapse = FALSE, log = TRUE, deep = c(1, 200))
bayes("single answers", "logistic", seq(0.1, 1, by = 0.1), c(0, 1, 1, 0, 1, 1, 0, 1, 1, 1), rep(1, 10), 0.5, deep = c(40, 40))
bayes("preference", "normal", 1:5, c(4, 6, 10, 15, 16), rep(20, 5), NA, points = 100, deep = c(16, 24))
writeLines(c(paste("name,family,log,falling,guess,free_lapse,levels,k,n",
                   paste(outer(c("mean", "sd", "median", "low", "high"), c("threshold", "width", "lapse", "eta"),
                               function(a, b) paste0(b, "_", a)), collapse = ","), sep = ","), unlist(rows)),
           "psychometric_bayes.csv")
