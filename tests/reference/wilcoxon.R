# Reference values for analysis/stats/wilcoxon: run with Rscript, writes wilcoxon.csv beside itself.
# A line: how, alternative, conf, mean, pratt, expected (V, p, estimate, low, high; NA: not compared), values.
#   enumerated: p by going through all 2^n signs of the ranks     wilcox: wilcox.test(exact = TRUE), no ties, no zeros
#   fourier: p by inverting the characteristic function of V, ties and zeros, more people than can be enumerated
#   normal: wilcox.test(exact = FALSE, correct = TRUE), more than 500 values; its estimate is not a Walsh average
# Estimate and interval of the others: all averages sorted, and the interval's ranks by qsignrank.
set.seed(19450601)
lines <- c()
short <- function(v) { s <- sprintf("%.15g", v); if (is.finite(v) && as.numeric(s) != v) sprintf("%.17g", v) else s }
show <- function(x) paste(vapply(x, short, ""), collapse = " ")
tails <- c("two.sided", "less", "greater")
add <- function(how, a, conf, mean, pratt, expected, x)
  lines <<- c(lines, paste(how, a, sprintf("%.17g", conf), sprintf("%.17g", mean), as.integer(pratt), show(expected), show(x), sep = ","))
ranked <- function(x, mean, pratt) {
  d <- x - mean
  if (!pratt) d <- d[d != 0]
  r <- rank(abs(d))
  list(r = r[d != 0], v = sum(r[d > 0]))
}
combine <- function(less, greater, a) switch(a, less = less, greater = greater, two.sided = min(1, 2 * min(less, greater)))
enumerate <- function(r, v, a) {
  sums <- 0
  for (x in r) sums <- c(sums, sums + x) # every choice of positive ones
  combine(mean(sums <= v + 1e-9), mean(sums >= v - 1e-9), a)
}
fourier <- function(r, v, a) { # P(2V = k) = 1/m sum_j phi(2 pi j / m) exp(-2 pi i j k / m)
  r <- 2 * r; m <- sum(r) + 1; j <- 0:(m - 1)
  phi <- rep(1 + 0i, m)
  for (x in r) phi <- phi * (1 + exp(2i * pi * ((j * x) %% m) / m)) / 2
  prob <- Re(fft(phi)) / m
  k <- 0:(m - 1)
  combine(sum(prob[k <= 2 * v]), sum(prob[k >= 2 * v]), a)
}
walsh <- function(x, conf, a) {
  w <- outer(x, x, "+") / 2
  w <- sort(w[!lower.tri(w)])
  n <- length(x); tail <- (1 - conf) / (if (a == "two.sided") 2 else 1)
  k <- qsignrank(tail, n) # the least with P(V <= k) >= tail
  if (isTRUE(psignrank(k, n) <= tail)) k <- k + 1
  low <- if (k < 1) -Inf else w[k]
  high <- if (k < 1) Inf else w[length(w) + 1 - k]
  c(median(w), if (a == "less") -Inf else low, if (a == "greater") Inf else high)
}
for (i in 1:60) { # ties, zeros, one and two values
  n <- if (i <= 4) c(1, 2, 2, 3)[i] else sample(3:14, 1)
  x <- switch(i %% 3 + 1, sample(-3:4, n, TRUE), sample(c(-2, -1, 0, 0, 1, 2, 5), n, TRUE), sample(1:10, n, TRUE) / 4)
  mean <- if (i %% 5 == 0) 0.5 else 0
  pratt <- i %% 2 == 0; a <- sample(tails, 1); conf <- sample(c(0.8, 0.9, 0.95), 1)
  q <- ranked(x, mean, pratt)
  p <- if (length(q$r)) enumerate(q$r, q$v, a) else NaN
  add("enumerated", a, conf, mean, pratt, c(q$v, p, walsh(x, conf, a)), x)
}
for (i in 1:40) {
  n <- if (i <= 4) i + 1 else sample(5:49, 1)
  x <- round(rnorm(n, 0.4, 1), 6)
  a <- sample(tails, 1); conf <- sample(c(0.8, 0.9, 0.95, 0.99), 1)
  t <- suppressWarnings(wilcox.test(x, alternative = a, conf.int = TRUE, conf.level = conf, exact = TRUE))
  reached <- attr(t$conf.int, "conf.level") # less than asked: there is no such interval
  bounds <- if (reached < conf - 1e-9) c(-Inf, Inf) else t$conf.int
  add("wilcox", a, conf, 0, FALSE, c(t$statistic, t$p.value, t$estimate, bounds), x)
}
for (i in 1:30) {
  n <- sample(20:90, 1)
  x <- sample(-4:5, n, TRUE)
  pratt <- i %% 2 == 0; a <- sample(tails, 1); conf <- sample(c(0.9, 0.95), 1)
  q <- ranked(x, 0, pratt)
  add("fourier", a, conf, 0, pratt, c(q$v, fourier(q$r, q$v, a), walsh(x, conf, a)), x)
}
for (i in 1:6) {
  n <- sample(530:600, 1)
  x <- sample(-20:22, n, TRUE)
  a <- tails[i %% 3 + 1]
  t <- wilcox.test(x, alternative = a, exact = FALSE)
  add("normal", a, 0.95, 0, FALSE, c(t$statistic, t$p.value, NA, NA, NA), x)
}
writeLines(lines, "wilcoxon.csv")
