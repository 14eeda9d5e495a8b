# The bootstrap interval of one pair of options, each person with one answer, for analysis/stats/thurstone: run with Rscript,
# writes thurstone_bootstrap.csv beside itself. In closed form: of n people of whom k preferred the option, a replicate has a
# binomial number of them, and its score is qnorm(number / n) / qnorm(0.75), infinite where all or none did. The shares of
# replicates at either infinity are exact, and so are the percentiles, where no step of the distribution lies near one (checked).
# Columns: k, n, at_minus_infinity, at_infinity (shares of replicates), low, high (95 %).
rows <- sapply(list(c(3, 12), c(9, 12), c(1, 10), c(6, 22), c(2, 20), c(18, 20), c(1, 2), c(5, 30), c(4, 12)), function(v) {
  k <- v[1]; n <- v[2]
  stopifnot(min(abs(outer(pbinom(0:n, n, k / n), c(0.025, 0.975), "-"))) > 0.003)
  ends <- qnorm(qbinom(c(0.025, 0.975), n, k / n) / n) / qnorm(0.75)
  paste(c(k, n, sprintf("%.17g", c(dbinom(c(0, n), n, k / n), ends))), collapse = ",")
})
writeLines(c("k,n,at_minus_infinity,at_infinity,low,high", rows), "thurstone_bootstrap.csv")
