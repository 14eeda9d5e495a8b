# What the papers print of their statistics against what follows from their other printed numbers: run with Rscript, writes
# papers.csv beside itself (what, printed, computed, difference). The README's list has these rows. Sources: Weier et al. 2016,
# section 4.2.2 (15 people, 1440 trials, three fixation modes: 480 each); Franke et al. 2021, sections 8.2 and 8.3.
lines <- "what,printed,computed,difference"
add <- function(what, printed, computed)
  lines[length(lines) + 1] <<- sprintf("%s,%.15g,%.15g,%.15g", what, printed, computed, computed - printed)
mean3 <- c(0.43, 0.43, 0.99); sd3 <- c(1.89, 1.81, 1.63)
within <- mean(sd3^2)
add("Weier fixation: F of trials", 3.46, 480 * var(mean3) / within)
add("Weier fixation: answers per mode that give the F", 480, 3.46 * within / var(mean3))
add("Weier fixation: p of the printed F with trials as residual (2; 1437)", 0.03, pf(3.46, 2, 1437, lower.tail = FALSE))
add("Weier fixation: p of the printed F within people (2; 28)", 0.03, pf(3.46, 2, 28, lower.tail = FALSE))
nearest <- function(p, n) { all <- sapply(0:n, function(k) binom.test(k, n)$p.value); all[which.min(abs(all - p))] }
add("Franke 8.3 scene type: nearest binomial p of 22", 0.091, nearest(0.091, 22))
add("Franke 8.3 mixed mode: nearest binomial p of 22", 0.012, nearest(0.012, 22))
add("Franke 8.3 smallest share of the four tests: 7 of 22 in percent", 32, 100 * 7 / 22)
add("Franke 8.3 largest share of the four tests: 15 of 22 in percent", 68, 100 * 15 / 22)
# Stengel et al. 2016, section 7.2 (16 people, 6 trials a test in pairs: 48 answers; T3 once a person: 16): the nearest whole
# number of answers, in percent. The design is that of section 6.2.
share <- function(percent, of) 100 * round(percent / 100 * of) / of
add("Stengel T1: percent without a difference; of 48", 87.5, share(87.5, 48))
add("Stengel T2: percent without a difference; of 48", 88.9, share(88.9, 48))
add("Stengel T3: percent recognised; of 16", 26.6, share(26.6, 16))
add("Stengel T4: percent negative; of 48", 12.2, share(12.2, 48))
add("Stengel T5: percent recognised; of 48", 6.7, share(6.7, 48))
add("Stengel T6: percent perceived; of 48", 20.2, share(20.2, 48))
add("Franke 8.2 null region of 19: low", 5, min(which(sapply(0:19, function(k) binom.test(k, 19)$p.value) > 0.05)) - 1)
add("Franke 8.2 null region of 19: high", 14, max(which(sapply(0:19, function(k) binom.test(k, 19)$p.value) > 0.05)) - 1)
add("Franke 8.2 null region of 22: low", 6, min(which(sapply(0:22, function(k) binom.test(k, 22)$p.value) > 0.05)) - 1)
add("Franke 8.2 null region of 22: high", 16, max(which(sapply(0:22, function(k) binom.test(k, 22)$p.value) > 0.05)) - 1)
writeLines(lines, "papers.csv")
