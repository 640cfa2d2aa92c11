:- module(order, [order_goal/2]).
order_goal(G,G).
