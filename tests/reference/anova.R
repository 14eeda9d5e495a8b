# Reference values for analysis/stats/anova and within: run with Rscript, writes anova.csv beside itself.
# F, p and sums of squares by aov with an Error term for every effect; epsilons by the machinery of anova.mlm
# (test = "Spherical"), which projects on the effect's own space by a formula in the cells' factors.
#   data, levels, people, values person by person, the last factor fastest      its effects follow, then perhaps
#   effect, mask (bit j: factor j), SS, error SS, df, error df, F, p, GG, HF, p of GG, p of HF, partial, generalised eta squared
#   within, conf, mean and half width of every cell, by one-sample t intervals of the normalised values
set.seed(20161107)
lines <- c()
short <- function(v) { s <- sprintf("%.15g", v); if (is.finite(v) && as.numeric(s) != v) sprintf("%.17g", v) else s }
show <- function(x) paste(vapply(x, short, ""), collapse = " ")
add <- function(...) lines <<- c(lines, paste(..., sep = ","))
design <- function(levels) {
  grid <- rev(expand.grid(lapply(rev(levels), seq_len)))
  names(grid) <- letters[seq_along(levels)]
  as.data.frame(lapply(grid, factor))
}
epsilons <- function(y, cells, term) {
  own <- reformulate(paste(term, collapse = "*"))
  parts <- if (length(term) == 1) ~1 else reformulate(
    sapply(seq_along(term), function(i) paste(term[-i], collapse = "*")))
  object <- structure(list(SSD = crossprod(scale(y, scale = FALSE)), df = nrow(y) - 1), class = "SSD")
  stats:::sphericity(object, M = own, X = parts, idata = cells)
}
analyse <- function(y, levels) {
  cells <- design(levels)
  factors <- names(cells)
  long <- cbind(cells[rep(seq_len(nrow(cells)), nrow(y)), , drop = FALSE],
                person = factor(rep(seq_len(nrow(y)), each = nrow(cells))), y = as.vector(t(y)))
  model <- as.formula(sprintf("y ~ %s + Error(person/(%s))", paste(factors, collapse = "*"), paste(factors, collapse = "*")))
  strata <- summary(aov(model, long))
  tables <- lapply(strata, function(s) s[[1]])
  errors <- sum(sapply(tables, function(t) t["Residuals", "Sum Sq"]))
  add("data", show(levels), nrow(y), show(as.vector(t(y))))
  for (t in tables[-1]) {
    term <- strsplit(trimws(rownames(t)[1]), ":")[[1]]
    ss <- t[1, "Sum Sq"]; error <- t["Residuals", "Sum Sq"]
    df <- t[1, "Df"]; df_error <- t["Residuals", "Df"]
    f <- t[1, "F value"]
    e <- epsilons(y, cells, term)
    gg <- e$GG.eps; hf <- min(1, e$HF.eps)
    if (df == 1) gg <- hf <- 1
    else if (nrow(y) == 2) hf <- NaN # 0 / 0
    add("effect", sum(2^(match(term, factors) - 1)), show(c(ss, error, df, df_error, f, t[1, "Pr(>F)"], gg, hf,
        pf(f, df * gg, df_error * gg, lower.tail = FALSE), pf(f, df * hf, df_error * hf, lower.tail = FALSE),
        ss / (ss + error), ss / (ss + errors))))
  }
  conf <- sample(c(0.9, 0.95, 0.99), 1)
  z <- y - rowMeans(y) + mean(y)
  half <- apply(z, 2, function(x) if (sd(x) > 1e-9) diff(t.test(x, conf.level = conf)$conf.int) / 2 else 0)
  add("within", sprintf("%.17g", conf), show(colMeans(y)), show(half * sqrt(ncol(y) / (ncol(y) - 1))))
}
designs <- list(2, 3, 4, 5, 7, c(2, 2), c(3, 2), c(2, 4), c(3, 3), c(4, 4), c(2, 2, 2), c(3, 2, 2), c(4, 4, 3),
                c(2, 3, 4), c(2, 2, 2, 2), c(2, 3, 2, 3))
for (levels in designs) {
  k <- prod(levels)
  for (kind in 1:4) {
    n <- sample(switch(kind, 3:6, 8:22, 2:3, 14:15), 1)
    if (kind == 3 && k == 2) n <- 3
    person <- rnorm(n, 0, 1.5)
    shift <- rnorm(k, 0, 0.7)
    noise <- matrix(rnorm(n * k), n) %*% diag(runif(k, 0.5, 2), k)
    y <- outer(person, shift, "+") + noise
    if (kind %in% c(1, 4)) y <- pmin(pmax(round(5.5 + y), 1), 10) # ratings, with ties
    else y <- round(y, 2)
    if (kind == 4) y[, 1] <- 7 # a column without spread
    analyse(y, levels)
  }
}
writeLines(lines, "anova.csv")
