# Reference values for analysis/stats mcnemar, chi_squared, fisher (larger tables), cochran, people and
# binomial_sample_size: run with Rscript, writes counts.csv beside itself.
# Lines: what, input, expected; numbers by spaces.
#   mcnemar: b c conf -> exact p, mid-p, chi-squared, p, corrected, p, odds ratio, low, high (mcnemar.test, binom.test)
#   chi_squared: rows columns counts by row -> statistic df p corrected p least expected (chisq.test)
#   fisher: rows columns counts by row -> p (fisher.test)
#   cochran: people conditions answers by person -> Q df p, p of every placement of each person's yeses
#   people: people groups categories, groups, counts by person -> chi-squared (chisq.test), p of every arrangement
#   size: p0 p alpha power -> first stays, by every n up to 1500 and every k by the definition of small p-values
set.seed(20211105)
lines <- c("what,input,expected")
show <- function(x) paste(sprintf("%.17g", x), collapse = " ")
add <- function(what, input, expected) lines <<- c(lines, paste(what, show(input), show(expected), sep = ","))

mcnemar <- function(b, c, conf = 0.95) {
  m <- matrix(c(5, c, b, 7), 2)
  plain <- mcnemar.test(m, correct = FALSE)
  corrected <- mcnemar.test(m, correct = TRUE)
  exact <- binom.test(b, b + c, 0.5, conf.level = conf)
  d <- dbinom(0:(b + c), b + c, 0.5)
  here <- d[b + 1]
  mid <- sum(d[d < here / (1 + 1e-7)]) + sum(d[abs(d / here - 1) <= 1e-7]) / 2
  ci <- exact$conf.int / (1 - exact$conf.int)
  add("mcnemar", c(b, c, conf), c(exact$p.value, mid, plain$statistic, plain$p.value, corrected$statistic,
                                  corrected$p.value, b / c, ci))
}
for (bc in list(c(1, 0), c(0, 1), c(0, 6), c(9, 0), c(1, 1), c(7, 7), c(5, 6), c(10, 2), c(2, 10), c(86, 150), c(300, 251),
                c(1, 400)))
  mcnemar(bc[1], bc[2])
mcnemar(12, 3, 0.99)
for (i in 1:15) mcnemar(rpois(1, 20) + 1, rpois(1, 12), sample(c(0.8, 0.9, 0.95), 1))

by_row <- function(m) as.vector(t(m))
chi <- function(m) {
  plain <- suppressWarnings(chisq.test(m, correct = FALSE))
  two <- all(dim(m) == 2)
  yates <- if (two) suppressWarnings(chisq.test(m)) else list(statistic = NaN, p.value = NaN)
  add("chi_squared", c(dim(m), by_row(m)),
      c(plain$statistic, plain$parameter, plain$p.value, yates$statistic, yates$p.value, min(plain$expected)))
}
chi(matrix(c(12, 5, 7, 7), 2))
chi(matrix(c(0, 5, 7, 0), 2))
chi(matrix(c(10, 10, 10, 10), 2))
chi(matrix(c(10, 10, 10, 11), 2)) # closer to its expectation than one half
chi(matrix(c(762, 484, 327, 239, 468, 477), 2)) # Agresti 2007, p. 39, as in chisq.test's help
chi(matrix(c(1e6, 1.001e6, 1.002e6, 1e6), 2))
for (i in 1:20) {
  m <- matrix(rpois(sample(2:5, 1) * 4, sample(c(2, 6, 30), 1)), 4)
  if (i %% 3 == 0) m <- m[1:2, 1:2]
  if (all(rowSums(m) > 0) && all(colSums(m) > 0)) chi(m)
}

fisher <- function(m) add("fisher", c(dim(m), by_row(m)), fisher.test(m, workspace = 2e7)$p.value)
fisher(matrix(c(1, 2, 1, 0, 3, 3, 6, 1, 10, 10, 14, 9, 6, 7, 12, 11), 4)) # Agresti 2002, p. 57: fisher.test's help
fisher(matrix(c(3, 1, 2, 4), 2))
fisher(matrix(c(4, 0, 0, 0, 4, 0, 0, 0, 4), 3))
fisher(matrix(c(2, 0, 3, 1, 0, 4), 2))
fisher(matrix(c(5, 0, 0, 2, 0, 3, 4, 0, 6), 3)) # ties
fisher(matrix(c(2, 2, 2, 2, 2, 2), 3)) # p is 1
fisher(matrix(c(40, 30, 20, 25, 35, 28), 2))
for (i in 1:20) {
  m <- matrix(rpois(sample(2:4, 1) * 3, sample(c(1, 2, 4), 1)), 3)
  if (all(rowSums(m) > 0) && all(colSums(m) > 0)) fisher(m)
}

q_of <- function(x) {
  k <- ncol(x)
  (k - 1) * (k * sum(colSums(x)^2) - sum(x)^2) / (k * sum(x) - sum(rowSums(x)^2))
}
placements <- function(row) lapply(combn(length(row), sum(row), simplify = FALSE), function(at) {
  r <- rep(0, length(row))
  r[at] <- 1
  r
})
cochran <- function(x) {
  q <- q_of(x)
  ways <- apply(x, 1, placements, simplify = FALSE)
  grid <- expand.grid(lapply(ways, seq_along))
  all <- apply(grid, 1, function(which) q_of(t(sapply(seq_along(ways), function(i) ways[[i]][[which[i]]]))))
  add("cochran", c(dim(x), by_row(x)), c(q, ncol(x) - 1, pchisq(q, ncol(x) - 1, lower.tail = FALSE),
                                         mean(all >= q - 1e-9)))
}
cochran(matrix(c(1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0), 5))
cochran(matrix(c(0, 0, 1, 1, 1, 1, 1, 0, 0, 1, 1, 1), 6)) # two conditions; people of one answer among them
cochran(matrix(c(1, 0, 0, 0), 1)) # one person
for (i in 1:12) {
  x <- matrix(rbinom(5 * sample(3:4, 1), 1, 0.5), 5)
  if (ncol(x) * sum(x) > sum(rowSums(x)^2)) cochran(x)
}

people <- function(group, counts) {
  statistic <- function(g) {
    m <- rowsum(counts, g)
    e <- outer(rowSums(m), colSums(m)) / sum(m)
    sum(((m - e)^2 / e)[rowSums(m) > 0, ])
  }
  labels <- list(integer(0)) # every order of the labels once
  for (g in sort(unique(group))) {
    size <- sum(group == g)
    labels <- unlist(lapply(labels, function(at) {
      free <- setdiff(seq_along(group), abs(at))
      lapply(combn(length(free), size, simplify = FALSE), function(i) c(at, free[i]))
    }), recursive = FALSE)
  }
  sizes <- rep(sort(unique(group)), table(group))
  here <- statistic(group)
  stopifnot(abs(here - suppressWarnings(chisq.test(rowsum(counts, group), correct = FALSE)$statistic)) < 1e-9)
  all <- sapply(labels, function(at) {
    g <- integer(length(group))
    g[at] <- sizes
    statistic(g)
  })
  add("people", c(length(group), max(group) + 1, ncol(counts), group, by_row(counts)), c(here, mean(all >= here - 1e-9)))
}
people(c(0, 0, 0, 1, 1, 1), cbind(c(9, 8, 9, 2, 1, 3), c(1, 2, 1, 8, 9, 7)))
people(c(0, 0, 0, 0, 1, 1, 1, 1), cbind(c(5, 5, 5, 5, 5, 5, 5, 5), c(5, 5, 5, 5, 5, 5, 5, 5))) # all alike
people(c(0, 1, 0, 1, 0, 1, 2, 2), cbind(rpois(8, 5) + 1, rpois(8, 5), rpois(8, 2)))
people(c(0, 0, 1, 1, 1), cbind(c(4, 0, 1, 2, 0), c(1, 0, 2, 2, 0))) # some answered nothing
for (i in 1:8) {
  n <- sample(6:10, 1)
  people(sample(rep(0:1, length.out = n)), cbind(rbinom(n, 12, rbeta(n, 2, 2)), rpois(n, 6) + 1))
}

power_at <- function(n, p0, p, alpha) {
  d <- dbinom(0:n, n, p0)
  small <- sapply(d, function(x) sum(d[d <= x * (1 + 1e-7)]))
  sum(dbinom(0:n, n, p)[small <= alpha])
}
size <- function(p0, p, alpha, power, most = 500) {
  all <- sapply(1:most, power_at, p0, p, alpha)
  stays <- max(0, which(all < power)) + 1
  stopifnot(stays < most / 2)
  add("size", c(p0, p, alpha, power), c(min(which(all >= power)), stays))
}
for (p in c(0.7, 0.75, 0.8, 0.95, 1, 0.3, 0)) for (power in c(0.8, 0.95)) size(0.5, p, 0.05, power)
size(0.5, 0.75, 0.01, 0.9)
size(0.5, 0.65, 0.1, 0.8)
size(0.2, 0.4, 0.05, 0.8)
size(0.2, 0.05, 0.05, 0.8)
size(0.9, 0.6, 0.01, 0.9)
size(0.05, 0.2, 0.05, 0.9)
size(0, 0.1, 0.05, 0.8)
size(1, 0.7, 0.05, 0.8)
size(0.5, 0.6, 0.05, 0.8, 600)
writeLines(lines, "counts.csv")
