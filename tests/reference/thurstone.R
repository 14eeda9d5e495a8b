# Reference values for analysis/stats/thurstone: run with Rscript, writes thurstone.csv beside itself.
# Columns: name, options, reference, wins (row by row, by spaces), scores (NA: not estimable), log_likelihood (NA where one
# score is), std_errors. Scores by glm with the probit link, whose coefficients are differences over sigma; who can be
# scaled by powers of the matrix of who beat whom.
set.seed(1927)
sigma <- 1 / qnorm(0.75)
rows <- list()
num <- function(x) paste(sprintf("%.17g", x), collapse = " ")
scale_of <- function(name, wins, reference = 1) {
  n <- nrow(wins)
  beats <- (wins > 0) | diag(n) > 0
  reach <- beats
  for (i in 1:n) reach <- (reach %*% beats) > 0
  ok <- which(reach[, reference] & reach[reference, ])
  score <- error <- rep(NA, n); score[reference] <- 0; ll <- NA
  if (length(ok) > 1) {
    pairs <- which(upper.tri(wins), arr.ind = TRUE)
    pairs <- pairs[pairs[, 1] %in% ok & pairs[, 2] %in% ok, , drop = FALSE]
    w <- wins[pairs]; l <- wins[pairs[, 2:1, drop = FALSE]]
    X <- matrix(0, nrow(pairs), n)
    X[cbind(seq_len(nrow(pairs)), pairs[, 1])] <- 1; X[cbind(seq_len(nrow(pairs)), pairs[, 2])] <- -1
    others <- setdiff(ok, reference)
    used <- w + l > 0
    fit <- glm(cbind(w, l)[used, , drop = FALSE] ~ X[used, others, drop = FALSE] - 1, family = binomial("probit"),
               control = glm.control(epsilon = 1e-15, maxit = 200))
    score[others] <- sigma * coef(fit)
    error[others] <- sigma * sqrt(diag(vcov(fit)))
    if (length(ok) == n) ll <- sum(wins * pnorm(outer(score, score, "-") / sigma, log.p = TRUE) * (wins > 0))
  }
  rows[[length(rows) + 1]] <<- paste(c(name, n, reference - 1, num(t(wins)), num(score), num(ll), num(error)), collapse = ",")
}
m <- function(...) matrix(c(...), nrow = sqrt(length(c(...))), byrow = TRUE)
scale_of("one pair", m(0, 16, 6, 0))
scale_of("three to one", m(0, 15, 5, 0))
scale_of("even", m(0, 10, 10, 0))
scale_of("star", m(0, 16, 14, 18, 6, 0, 0, 0, 8, 0, 0, 0, 4, 0, 0, 0))
scale_of("unanimous for", m(0, 0, 20, 0))
scale_of("unanimous against", m(0, 20, 0, 0))
scale_of("one unanimous in a star", m(0, 16, 22, 6, 0, 0, 0, 0, 0))
scale_of("unanimous pairs in a chain", m(0, 5, 0, 5, 0, 9, 0, 1, 0))
scale_of("cycle of unanimous pairs", m(0, 10, 0, 0, 0, 10, 10, 0, 0))
scale_of("apart", m(0, 6, 0, 0, 4, 0, 0, 0, 0, 0, 0, 5, 0, 0, 5, 0))
scale_of("all one way", m(0, 9, 9, 0, 0, 9, 0, 0, 0), 2)
for (n in c(3, 4, 5, 6, 8, 10)) for (per in c(5, 20)) {
  q <- rnorm(n)
  wins <- matrix(0, n, n)
  for (i in 1:(n - 1)) for (j in (i + 1):n) {
    wins[i, j] <- rbinom(1, per, pnorm((q[i] - q[j]) / sigma)); wins[j, i] <- per - wins[i, j]
  }
  scale_of(paste("drawn", n, per), wins, 1 + n %/% 2)
}
writeLines(c("name,options,reference,wins,scores,log_likelihood,std_errors", unlist(rows)), "thurstone.csv")
