# Reference values for analysis/report/choice_three: run with Rscript, writes choice_three.csv beside itself.
# Ten people; person p answered 2 + p %% 4 times: test (3 p) %% (2 + p %% 4), of the rest (5 p) %% (rest + 1) equal.
# Net preference and negative share by t.test over people; p by all 2^10 signs of test - reference.
p <- 1:10; n <- 2 + p %% 4; test <- (3 * p) %% n; equal <- (5 * p) %% (n - test + 1); reference <- n - test - equal
net <- (test - reference) / n; negative <- reference / n; d <- test - reference
signs <- as.matrix(expand.grid(rep(list(c(-1, 1)), 10)))
flip <- mean(abs(signs %*% d) >= abs(sum(d)))
value <- c(test = sum(test), equal = sum(equal), reference = sum(reference), negative = mean(negative),
           negative_low = t.test(negative)$conf.int[1], negative_high = t.test(negative)$conf.int[2], net = mean(net),
           net_low = t.test(net)$conf.int[1], net_high = t.test(net)$conf.int[2], p = flip)
writeLines(c("what,value", sprintf("%s,%.17g", names(value), value)), "choice_three.csv")
