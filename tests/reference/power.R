# Reference values for analysis/stats/power: run with Rscript, writes power.csv beside itself.
# Columns: what, n, n2, x, alpha, power, value. Binomial regions by trying every k with binom.test, not by our method;
# margins by trying every c; t by power.t.test(strict = TRUE) and by pt with a noncentrality for unequal groups.
#   binomial_power: x is the true share, power NA     binomial_detectable, binomial_margin: x NA
#   paired_power, two_power: x is d                   paired_detectable, two_detectable: x NA
rows <- list()
add <- function(what, n, n2, x, alpha, power, value)
  rows[[length(rows) + 1]] <<- sprintf("%s,%d,%d,%.17g,%.17g,%.17g,%.17g", what, as.integer(n), as.integer(n2), x, alpha,
                                       power, value)
rejects <- function(n, alpha) (0:n)[sapply(0:n, function(k) binom.test(k, n)$p.value) <= alpha]
binomial_power <- function(n, p, alpha) sum(dbinom(rejects(n, alpha), n, p))
detectable <- function(n, alpha, power) {
  r <- rejects(n, alpha)
  if (length(r) == 0) return(NaN)
  uniroot(function(p) sum(dbinom(r, n, p)) - power, c(0.5, 1), tol = 1e-14)$root
}
# Two one-sided tests by binom.test itself: the smallest m on a root search per c, then the smallest m with the power.
margin <- function(n, alpha, power) {
  best <- NaN
  for (c in 1:max(1, floor(n / 2))) {
    if (sum(dbinom(c:(n - c), n, 0.5)) < power || c > n - c) next
    m <- uniroot(function(m) binom.test(c, n, 0.5 - m, "greater")$p.value - alpha, c(1e-9, 0.5 - 1e-12), tol = 1e-14)$root
    best <- min(best, m, na.rm = TRUE)
  }
  best
}
for (n in c(1, 2, 4, 5, 6, 7, 8, 10, 12, 15, 18, 19, 20, 21, 22, 25, 30, 36, 40, 48, 50, 64, 80, 100, 150, 200))
  for (alpha in c(0.01, 0.05, 0.1)) {
    for (p in c(0.5, 0.6, 0.75, 0.9, 1)) add("binomial_power", n, 0, p, alpha, NA, binomial_power(n, p, alpha))
    for (power in c(0.8, 0.95)) {
      add("binomial_detectable", n, 0, NA, alpha, power, detectable(n, alpha, power))
      add("binomial_margin", n, 0, NA, alpha, power, margin(n, alpha, power))
    }
  }
two_power <- function(n, m, d, alpha) {
  df <- n + m - 2
  ncp <- d * sqrt(n * m / (n + m))
  limit <- qt(alpha / 2, df, lower.tail = FALSE)
  pt(limit, df, ncp, lower.tail = FALSE) + pt(-limit, df, ncp)
}
for (n in c(2, 3, 5, 9, 10, 11, 15, 20, 22, 30, 50, 100))
  for (alpha in c(0.01, 0.05)) {
    for (d in c(0.2, 0.5, 1)) {
      add("paired_power", n, 0, d, alpha, NA, power.t.test(n, d, 1, alpha, type = "paired", strict = TRUE)$power)
      add("two_power", n, n, d, alpha, NA, power.t.test(n, d, 1, alpha, strict = TRUE)$power)
      add("two_power", n, n + 3, d, alpha, NA, two_power(n, n + 3, d, alpha))
    }
    for (power in c(0.8, 0.9)) {
      if (n > 2 || alpha > 0.01)
        add("paired_detectable", n, 0, NA, alpha, power,
            power.t.test(n, NULL, 1, alpha, power, "paired", strict = TRUE, tol = 1e-13)$delta)
      add("two_detectable", n, n, NA, alpha, power,
          power.t.test(n, NULL, 1, alpha, power, strict = TRUE, tol = 1e-13)$delta)
    }
  }
writeLines(c("what,n,n2,x,alpha,power,value", unlist(rows)), "power.csv")
