# Reference values for analysis/stats/{people,signflip,mixed_logit}: run with Rscript, writes people.csv beside itself.
# Needs lme4 for the columns glmer_*; the tests need only the CSV.
# Columns: name, k of each person (by spaces), n of each, flip_two, flip_less, flip_greater (all 2^N signs, one by one),
# share, t_low, t_high, t_p (t.test of the shares against 0.5), t_p6 (against 0.6, one-sided: greater), dispersion
# (chisq.test of people by answers, over its df), glmer_intercept, glmer_error, glmer_sd (nAGQ = 25), intercept, error, sd,
# loglik (the maximum of the likelihood integrated by integrate(), its Hessian by differences), population (the mean
# preference by integrate()). The log-likelihood is of single answers. NA where a thing does not exist, or where R's own way
# fails. glmer's 25 points are too few for "split but one", "one dissenter" and "two answers - two changed": its estimates
# are then far from the maximum.
suppressMessages(library(lme4))

flips <- function(k, n) {
  d <- k - n / 2
  d <- d[n > 0]
  sums <- function(d) if (length(d) == 0) 0 else as.vector(as.matrix(expand.grid(rep(list(c(-1, 1)), length(d)))) %*% d)
  h <- length(d) %/% 2
  a <- sums(d[seq_len(h)])
  b <- sums(d[h + seq_len(length(d) - h)])
  seen <- sum(d)
  two <- less <- greater <- 0
  for (x in a) {
    all <- x + b # halves of whole numbers: exact
    two <- two + sum(abs(all) >= abs(seen))
    less <- less + sum(all <= seen)
    greater <- greater + sum(all >= seen)
  }
  c(two, less, greater) / 2^length(d)
}

one_likelihood <- function(k, n, b0, s) {
  h <- function(b) {
    x <- b0 + s * b
    k * plogis(x, log.p = TRUE) + (n - k) * plogis(-x, log.p = TRUE) + dnorm(b, log = TRUE)
  }
  m <- optimize(h, c(-12, 12), maximum = TRUE, tol = 1e-10)
  w <- 1 / sqrt(max(1e-12, 1 + n * s^2 * plogis(b0 + s * m$maximum) * plogis(-(b0 + s * m$maximum))))
  f <- function(b) exp(h(b) - m$objective)
  cuts <- m$maximum + w * c(-40, -12, -4, 0, 4, 12, 40)
  cuts <- sort(unique(c(pmin(pmax(cuts, -40), 40), -40, 40)))
  pieces <- mapply(function(lo, hi) integrate(f, lo, hi, rel.tol = 1e-12, abs.tol = 0, stop.on.error = FALSE)$value,
                   head(cuts, -1), tail(cuts, -1))
  m$objective + log(sum(pieces))
}
loglik <- function(par, k, n) { # people with the same counts once
  same <- paste(k, n)
  first <- !duplicated(same)
  sum(mapply(one_likelihood, k[first], n[first], par[1], par[2]) * as.vector(table(same)[same[first]]))
}

second <- function(f, p) { # Hessian by central differences of fourth order
  h <- 2e-3
  one <- function(i) {
    e <- replace(c(0, 0), i, h)
    (-f(p + 2 * e) + 16 * f(p + e) - 30 * f(p) + 16 * f(p - e) - f(p - 2 * e)) / (12 * h^2)
  }
  cross <- function(h) (f(p + c(h, h)) - f(p + c(h, -h)) - f(p + c(-h, h)) + f(p - c(h, h))) / (4 * h^2)
  both <- (4 * cross(h) - cross(2 * h)) / 3
  matrix(c(one(1), both, both, one(2)), 2)
}

mixed <- function(k, n) {
  use <- n > 0
  k <- k[use]
  n <- n[use]
  out <- rep(NA, 8)
  if (length(n) < 2 || sum(k) %in% c(0, sum(n)) || max(n) < 2 || all(k == 0 | k == n)) return(out)
  id <- factor(seq_along(k))
  g <- try(suppressMessages(suppressWarnings(glmer(cbind(k, n - k) ~ 1 + (1 | id), family = binomial, nAGQ = 25,
      control = glmerControl(optimizer = "bobyqa", optCtrl = list(rhobeg = 0.2, rhoend = 1e-9))))), silent = TRUE)
  start <- c(qlogis(sum(k) / sum(n)), 1)
  if (!inherits(g, "try-error")) { # it refuses constant counts
    out[1:3] <- c(fixef(g), sqrt(vcov(g)[1, 1]), getME(g, "theta"))
    start <- out[c(1, 3)]
  }
  f <- function(p) loglik(c(p[1], abs(p[2])), k, n)
  best <- NULL
  for (s in c(0.3, max(0.05, start[2]), 2)) {
    o <- optim(c(start[1], s), function(p) -f(p), control = list(reltol = 1e-9))
    if (is.null(best) || o$value < best$value) best <- o
  }
  best <- optim(best$par, function(p) -f(p), control = list(reltol = 1e-16, maxit = 3000))
  p <- c(best$par[1], abs(best$par[2]))
  if (p[2] < 2e-3) { # the edge: the pooled answers
    share <- sum(k) / sum(n)
    p <- c(qlogis(share), 0)
    out[4:7] <- c(p[1], 1 / sqrt(sum(n) * share * (1 - share)), 0, f(p))
  } else {
    v <- solve(-second(f, p))
    out[4:7] <- c(p[1], sqrt(v[1, 1]), p[2], f(p))
  }
  out[8] <- integrate(function(b) plogis(p[1] + p[2] * b) * dnorm(b), -40, 40, rel.tol = 1e-12, subdivisions = 2000)$value
  out
}

number <- function(x) ifelse(is.na(x), "NA", sprintf("%.17g", x))
rows <- character(0)
add <- function(name, k, n) {
  k <- rep_len(as.integer(k), max(length(k), length(n)))
  n <- rep_len(as.integer(n), length(k))
  share <- (k / n)[n > 0]
  t <- rep(NA, 5)
  t[1] <- if (length(share)) mean(share) else NA
  if (length(share) > 1 && length(unique(share)) > 1) {
    test <- t.test(share, mu = 0.5)
    t[2:5] <- c(test$conf.int, test$p.value, t.test(share, mu = 0.6, alternative = "greater")$p.value)
  }
  dispersion <- NA
  if (length(share) > 1 && max(n) > 1 && !(sum(k) %in% c(0, sum(n))))
    dispersion <- suppressWarnings(chisq.test(rbind(k, n - k)[, n > 0], correct = FALSE)$statistic / (length(share) - 1))
  flip <- if (length(share) == 0) rep(NA, 3) else if (length(share) <= 24) flips(k, n) else rep(NA, 3)
  rows <<- c(rows, paste(c(name, paste(k, collapse = " "), paste(n, collapse = " "),
                           number(c(flip, t, dispersion, mixed(k, n)))), collapse = ","))
  cat(name, "\n")
}

add("nobody", 0, 0)
add("one person", 7, 10)
add("one person - all", 10, 10)
add("two people", c(6, 9), 10)
add("two people - apart", c(0, 10), 10)
add("none of n", rep(0, 8), 9)
add("all of n", rep(9, 8), 9)
add("all of n - unequal n", c(3, 4, 5, 6, 7, 8), c(3, 4, 5, 6, 7, 8))
add("one each", c(1, 0, 1, 1, 0, 1, 1, 1), 1)
add("even everywhere", rep(5, 6), 10)
add("even but one", c(5, 5, 5, 5, 5, 9), 10)
add("same share", rep(7, 6), 10)
add("same share - unequal n", c(2, 4, 6, 8, 10), c(4, 8, 12, 16, 20))
add("split", c(0, 9, 9, 0, 9, 9, 9), 9)
add("split but one", c(0, 9, 9, 1, 9, 9, 9), 9)
add("five people", c(7, 8, 9, 8, 9), 9)
add("six people", c(7, 8, 9, 8, 9, 6), 9)
add("six people - tie", c(7, 2, 7, 2, 7, 2), 9)
add("ties in size", c(8, 1, 8, 8, 1, 8, 8, 8), 9)
add("signs only", c(5, 5, 5, 4, 5, 5, 5, 4, 5, 5, 5, 5), 9)
add("some without answers", c(6, 0, 8, 0, 7, 9, 5), c(10, 0, 10, 0, 10, 10, 10))
add("two answers", c(2, 1, 0, 1, 2, 2, 1, 1, 2, 1), 2)
add("two answers - two changed", c(2, 2, 0, 1, 2, 0, 1, 2, 2, 2), 2)
add("one or three answers", c(1, 3, 0, 2, 1, 1, 3, 2, 0, 1), c(1, 3, 1, 3, 1, 3, 3, 3, 1, 3))
add("one person with many", c(90, 1, 2, 1, 0, 2, 1, 2), c(120, 3, 3, 3, 3, 3, 3, 3))
add("very unequal n", c(1, 4, 10, 30, 44, 3, 12, 5), c(2, 5, 20, 40, 90, 3, 16, 11))
add("far apart", c(1, 39, 2, 38, 20, 37, 3, 40, 39, 12), 40)
add("near the top", c(40, 39, 40, 38, 40, 40, 37, 40, 39, 40), 40)
add("near the bottom", c(0, 1, 0, 2, 0, 0, 3, 0, 1, 0), 12)
add("one dissenter", c(20, 20, 20, 20, 20, 20, 20, 20, 20, 3), 20)
add("many answers", c(512, 488, 530, 610, 499, 505, 470, 560), 1000)
add("under-dispersed", c(10, 10, 11, 10, 9, 10, 10, 11, 10, 10), 20)
add("mostly all", c(8, 9, 9, 6, 9, 7, 8, 9, 7, 9, 9, 9, 9, 3, 3, 9, 3, 9, 1, 9, 9), 9)
add("small study", (1:22 <= 6) + (5 * (1:22)) %% 9, 9) # study_file.h, the first cell with several answers
set.seed(20261125)
draw <- function(people, n, middle, sd) rbinom(people, n, plogis(qlogis(middle) + sd * rnorm(people)))
for (sd in c(0, 0.5, 1, 2))
  for (middle in c(0.5, 0.6, 0.75)) {
    add(sprintf("20x20 %g %g", middle, sd), draw(20, 20, middle, sd), 20)
    add(sprintf("21x9 %g %g", middle, sd), draw(21, 9, middle, sd), 9)
    add(sprintf("22x12 %g %g", middle, sd), draw(22, 12, middle, sd), 12)
    n <- sample(3:30, 14, TRUE)
    add(sprintf("14 unequal %g %g", middle, sd), draw(14, n, middle, sd), n)
  }
for (sd in c(0, 0.5, 1)) add(sprintf("24x40 %g", sd), draw(24, 40, 0.6, sd), 40)
for (sd in c(0.5, 1.5)) add(sprintf("52x96 %g", sd), draw(52, 96, 0.55, sd), 96)
writeLines(c(paste0("name,k,n,flip_two,flip_less,flip_greater,share,t_low,t_high,t_p,t_p6,dispersion,glmer_intercept,",
                    "glmer_error,glmer_sd,intercept,error,sd,loglik,population"), rows), "people.csv")
